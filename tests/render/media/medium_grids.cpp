#include "tests/render/media/medium_grids.h"

#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

namespace scree {

openvdb::FloatGrid::Ptr make_grid(int n, double h, const V3d& shift,
                                  const std::function<double(int, int, int)>& density)
{
    openvdb::initialize();
    auto grid = openvdb::FloatGrid::create(0);
    auto transform = openvdb::math::Transform::createLinearTransform(h);
    transform->postTranslate(openvdb::Vec3d(shift.x, shift.y, shift.z));
    grid->setTransform(transform);
    auto accessor = grid->getAccessor();
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k)
                accessor.setValue(openvdb::Coord(i, j, k), static_cast<float>(density(i, j, k)));
    return grid;
}

GridMedium make_medium(openvdb::GridBase::ConstPtr density, const GridMediumOptions& options, const RenderSpace& space)
{
    MediumGrids grids;
    grids.density = std::move(density);
    return make_grid_medium(grids, options, space, {});
}

double optical_depth(const GridMedium& medium, const TestRay& ray, double t0, double t1, int n)
{
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += double{medium.sigma_t(ray.o + ray.d * (t0 + (t1 - t0) * (i + 0.5) / n)).x};
    return sum * (t1 - t0) / n;
}

void expect_depth(const GridMedium& medium, const TestRay& ray, double depth, uint32_t n, uint64_t seed)
{
    const double truth = std::exp(-depth);
    Estimate ratio;
    double passed = 0;
    for (uint32_t i = 0; i < n; ++i) {
        Sampler sampler(seed, i, 0, 0);
        SpectralState state;
        const MediumEvent event = medium.event(ray.o, ray.d, ray.t0, ray.t1, state, sampler);
        passed += event.scattered ? 0 : 1;
        if (event.scattered) {
            EXPECT_GE(event.t, ray.t0);
            EXPECT_LE(event.t, ray.t1);
        }
        ratio.add(double{medium.transmittance(ray.o, ray.d, ray.t0, ray.t1, sampler).x});
    }
    // An estimate without variance has only the rounding error of floats.
    EXPECT_LT(std::abs(ratio.mean() - truth), 4 * ratio.standard_error() + 2e-7)
        << "transmittance " << ratio.mean() << " of " << truth;
    EXPECT_LT(std::abs(passed / n - truth), 4 * std::sqrt(truth * (1 - truth) / n) + 1e-12)
        << "passed " << passed / n << " of " << truth;
}

} // namespace scree
