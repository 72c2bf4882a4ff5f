// The white furnace with proxies: lossless grains are invisible in a constant environment with every sampling strategy.

#include "base/warp.h"
#include "render/integrators/path_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

namespace scree {
namespace {

const std::vector<PackedSphere>& bed()
{
    static const auto spheres = push_apart(4000, 0.62, 0.5, 0.09, 5);
    return spheres;
}

/// Mean radiance of paths from all sides towards the middle.
Estimate shine_in(const TestScene& scene, uint32_t paths, const PathOptions& options)
{
    std::vector<double> values(paths);
    tbb::parallel_for(uint32_t{0}, paths, [&](uint32_t p) {
        flush_subnormals();
        Sampler sampler(17, p, 0, 0);
        const double u1 = sampler.next(), u2 = sampler.next();
        const V3d o = 3.0 * sample_sphere(u1, u2);
        const V3d target(sampler.next() - 0.5, sampler.next() - 0.5, sampler.next() - 0.5);
        values[p] =
            trace_path(scene.world(), scene.tracer(), o, (target - o).normalized(), sampler, options).radiance.x;
    });
    Estimate radiance;
    for (const double value : values) radiance.add(value);
    return radiance;
}

struct ProxyCase {
    std::string name;
    Material material;
    int mesh_level; // -1: the sphere itself; 99: a cube
};

void PrintTo(const ProxyCase& c, std::ostream* out) { *out << c.name; }

class ProxyFurnace : public testing::TestWithParam<ProxyCase> {};

TEST_P(ProxyFurnace, IsWhite)
{
    const ProxyCase& c = GetParam();
    TestScene constant, sampled;
    for (TestScene* scene : {&constant, &sampled}) {
        const uint32_t type = c.mesh_level == 99  ? scene->add_type(c.material, cube())
                              : c.mesh_level >= 0 ? scene->add_type(c.material, icosphere(c.mesh_level))
                                                  : scene->add_type(c.material);
        if (scene == &constant)
            scene->add_proxies({0.1});
        else
            scene->set_gsdf(type, constant.world().types[0].gsdf);
        EXPECT_EQ(scene->world().types[type].gsdf->data().quality.lost, 0u);
        scene->add_grains(bed(), type);
    }
    constant.add_constant_light(1);
    sampled.add_white_environment();
    constant.build();
    sampled.build();
    for (const uint32_t explicit_grains : {0u, 2u}) {
        PathOptions options;
        options.explicit_grains = explicit_grains;
        const Estimate plain = shine_in(constant, 2000, options);
        EXPECT_NEAR(plain.mean(), 1, 1e-5) << c.name; // no lossless path ends without light
        for (const DirectLight strategy : {DirectLight::both, DirectLight::lights_only, DirectLight::scattering_only}) {
            options.direct_light = strategy;
            const Estimate e = shine_in(sampled, 20000, options);
            EXPECT_LT(std::abs(e.z(1)), 4) << c.name << ", " << explicit_grains << " grains as they are: " << e.mean()
                                           << " +- " << e.standard_error();
            std::printf("%-20s %u as they are, strategy %d: %.5f +- %.5f\n", c.name.c_str(), explicit_grains,
                        static_cast<int>(strategy), e.mean(), e.standard_error());
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Types, ProxyFurnace,
                         testing::Values(ProxyCase{"glass spheres", dielectric(1.5), -1},
                                         ProxyCase{"rough glass spheres", dielectric(1.5, 0.3), -1},
                                         ProxyCase{"glass mesh", dielectric(1.5), 1},
                                         ProxyCase{"glass cubes", dielectric(1.5), 99},
                                         ProxyCase{"white spheres", lambert(1), -1},
                                         ProxyCase{"white cubes", lambert(1), 99}));

} // namespace
} // namespace scree
