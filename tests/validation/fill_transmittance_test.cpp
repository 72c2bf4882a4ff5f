// The repetition of a fill must not affect light: a dilute fill attenuates a beam like independent spheres, along any
// direction.
//
// A parallel beam crosses a ball of radius R that contains only whole spheres. Their centres lie in the ball of radius
// R - r, and a ray at distance b from its middle hits those in a cylinder of radius r around the ray. The mean free
// path among hard spheres is 4 r (1 - f) / (3 f), exponential when dilute; so the transmittance is exp(-2 sqrt((R -
// r)^2 - b^2) 3 f / (4 r (1 - f))). Without rotation and variants far more of a beam along a lattice axis passes,
// because the same shadows repeat.

#include "base/sampler.h"
#include "mixtures/single_mixture.h"
#include "packing/tiles/tile_generator.h"
#include "render/trace/tracer.h"
#include "tests/builders/shapes.h"

#include <gmock/gmock.h>

namespace scree {
namespace {

constexpr double fraction = 0.01;

class FillTransmittance : public testing::Test {
protected:
    FillTransmittance()
    {
        TileOptions options;
        options.fraction = fraction;
        const auto tile =
            std::make_shared<const PackingTile>(make_tile(std::vector<double>(2000, 1.0), options, {}).tile);
        const auto domain = std::make_shared<const Domain>(icosphere(5), "ball");
        fill_ = std::make_shared<const ProceduralFill>(domain, tile, FillOptions{radius_, 0});
        world_.fill = std::make_shared<GrainFill>(fill_, std::make_shared<SingleMixture>(0), world_.space);
        world_.domain = domain->bounds();
        world_.types.push_back({"black", {}, nullptr});
        tracer_ = std::make_unique<Tracer>(std::make_shared<EmbreeDevice>(), world_);
    }

    /// The ratio of measured to expected transmittance of a beam along d, and its standard error from 64 patches of the
    /// beam.
    std::pair<double, double> ratio(const V3d& d, uint32_t seed) const
    {
        constexpr int side = 8, rays = 250;
        const Frame frame(d);
        double sum = 0, sum2 = 0, expected = 0;
        for (int patch = 0; patch < side * side; ++patch) {
            Sampler sampler(seed, static_cast<uint32_t>(patch), 0, 0);
            double open = 0;
            for (int i = 0; i < rays; ++i) {
                const double x = (patch % side + sampler.next()) / side - 0.5,
                             y = (patch / side + sampler.next()) / side - 0.5;
                const V3d o = frame.to_world({0.9 * x, 0.9 * y, -1.5});
                open += !tracer_->occluded(o, d, 3, {}, ~0u);
                const double b2 = 0.81 * (x * x + y * y), r = 1 - radius_;
                expected += std::exp(-2 * std::sqrt(r * r - b2) * 3 * fraction / (4 * radius_ * (1 - fraction)));
            }
            sum += open / rays;
            sum2 += open / rays * open / rays;
        }
        constexpr double n = side * side;
        const double mean = sum / n, error = std::sqrt((sum2 / n - mean * mean) / (n - 1));
        const double truth = expected / (n * rays);
        return {mean / truth, error / truth};
    }

    /// About forty directions of one kind: their mean ratio must be 1 within 4 standard errors, and no single one may
    /// deviate by more than 5.
    void expect_dim(const std::vector<V3d>& directions, const char* what) const
    {
        double mean = 0, variance = 0;
        for (size_t i = 0; i < directions.size(); ++i) {
            const auto [value, error] = ratio(directions[i].normalized(), static_cast<uint32_t>(i + 1));
            EXPECT_NEAR(value, 1, 5 * error) << what << " " << directions[i];
            mean += value / static_cast<double>(directions.size());
            variance += error * error / static_cast<double>(directions.size() * directions.size());
        }
        std::printf("%s: transmittance over expectation %.3f +- %.3f\n", what, mean, std::sqrt(variance));
        EXPECT_NEAR(mean, 1, 4 * std::sqrt(variance)) << what;
        EXPECT_LT(std::sqrt(variance), 0.1) << "too weak a test";
    }

    double radius_ = 0.004; // optical depth through the middle: 3.8
    std::shared_ptr<const ProceduralFill> fill_;
    World world_;
    std::unique_ptr<Tracer> tracer_;
};

TEST_F(FillTransmittance, AlongAxesAndDiagonals)
{
    expect_dim({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, "axes");
    expect_dim({{1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {1, 0, -1}, {0, 1, 1}, {0, 1, -1}}, "face diagonals");
    expect_dim({{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}}, "space diagonals");
}

TEST_F(FillTransmittance, AlongRandomDirections)
{
    std::vector<V3d> directions;
    Sampler sampler(9, 0, 0, 0);
    for (int i = 0; i < 24; ++i) {
        const double z = 2 * sampler.next() - 1, phi = 2 * pi * sampler.next(), s = std::sqrt(1 - z * z);
        directions.emplace_back(s * std::cos(phi), s * std::sin(phi), z);
    }
    expect_dim(directions, "random directions");
}

// Shows why the rotation is needed, and that the tests above can fail: along its own axes the lattice has an effect
// (boundary spheres repeat).
TEST_F(FillTransmittance, AlongTheLatticeItselfMore)
{
    double mean = 0;
    for (int axis = 0; axis < 3; ++axis) {
        V3d d(0);
        d[axis] = 1;
        mean += ratio(fill_->from_lattice(d).normalized(), 77).first / 3;
    }
    std::printf("the lattice's own axes: transmittance over expectation %.3f\n", mean);
    EXPECT_GT(mean, 1.1);
}

} // namespace
} // namespace scree
