// Direct light by light sampling, by scattering alone, and by both with MIS weights: three estimators of one image.

#include "render/integrators/path_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

void add_lights(TestScene& scene)
{
    scene.add_light(rectangle_light(V3d(-2, -2, 5), V3d(4, 0, 0), V3d(0, 4, 0.5), 2));
    scene.add_light(sphere_light(V3d(3, -1, 2), 0.7, 6));
    scene.add_light(distant_light(V3d(-1, -1, 1), 1 - std::cos(12 * pi / 180), 5));
    std::vector<Color> texels(32 * 16);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = Color(i % 37 == 0 ? 4.0f : 0.2f);
    Light sky;
    sky.kind = LightKind::environment;
    sky.map = std::make_shared<EnvironmentMap>(texels, 32, 16, V3d(0, 0, 1), Color(1));
    scene.add_light(sky);
}

// Matte, rough glass, rough metal and smooth glass grains on a floor, four kinds of light.
TEST(DirectLight, EveryStrategyGivesTheSamePicture)
{
    TestScene scene;
    Material metal;
    metal.kind = MaterialKind::conductor;
    metal.eta = Color(1.5f);
    metal.k = Color(3);
    metal.alpha = 0.2;
    const uint32_t types[] = {scene.add_type(lambert(0.7f)), scene.add_type(dielectric(1.5, 0.3)),
                              scene.add_type(metal), scene.add_type(dielectric(1.5)),
                              scene.add_type(lambert(0.5f), cube())};
    for (int i = 0; i < 25; ++i)
        scene.add_grain(V3d(1.3 * (i % 5) - 2.6, 1.3 * (i / 5) - 2.6, 0.6), 0.6, types[(i * 7) % 5]);
    scene.add_surface(ground(8, 0), lambert(0.6f));
    add_lights(scene);
    scene.build();

    Estimate mean[3];
    const RenderSpace space = scene.space();
    for (uint32_t s = 0; s < 3; ++s) {
        PathOptions options;
        options.direct_light = static_cast<DirectLight>(s);
        for (uint32_t i = 0; i < 300000; ++i) {
            Sampler sampler(31 + s, i, 0, 0);
            const V3d target(5 * sampler.next() - 2.5, 5 * sampler.next() - 2.5, 0.5);
            const V3d o = space.point({1, -9, 7}), d = (space.point(target) - o).normalized();
            mean[s].add(trace_path(scene.world(), scene.tracer(), o, d, sampler, options).radiance.x);
        }
        std::printf("strategy %u: %.5f +- %.5f\n", s, mean[s].mean(), mean[s].standard_error());
    }
    for (int a = 0; a < 3; ++a) {
        EXPECT_LT(mean[a].standard_error(), 0.012 * mean[a].mean());
        for (int b = 0; b < a; ++b) {
            EXPECT_LT(std::abs(mean[a].mean() - mean[b].mean()),
                      4 * std::hypot(mean[a].standard_error(), mean[b].standard_error()));
        }
    }
    EXPECT_LT(mean[0].standard_error(), mean[1].standard_error());
    EXPECT_LT(mean[0].standard_error(), mean[2].standard_error());
}

// Irradiance on a floor in closed form: a sphere light of radius r at height h straight above gives E = pi L (r / h)^2;
// the sun of irradiance E at cosine c gives c E. A floor of reflectance rho then has radiance rho E / pi.
TEST(DirectLight, FloorShowsTheIrradianceByHand)
{
    TestScene scene;
    scene.add_surface(ground(4, 0), lambert(0.8f));
    scene.add_light(sphere_light(V3d(0, 0, 2), 0.5, 3));
    scene.add_light(
        distant_light(V3d(0, 0.6, 0.8), 1 - std::cos(0.00463),
                      static_cast<float>(2 / (pi * std::sin(0.00463) * std::sin(0.00463))))); // irradiance 2
    scene.build();
    Estimate radiance;
    for (uint32_t i = 0; i < 100000; ++i) {
        Sampler sampler(3, i, 0, 0);
        const V3d o(1.5, 0, 1.0), d = (V3d(0) - o).normalized();
        radiance.add(trace_path(scene.world(), scene.tracer(), o, d, sampler).radiance.x);
    }
    const double irradiance = pi * 3 * (0.5 / 2) * (0.5 / 2) + 2 * 0.8;
    EXPECT_LT(std::abs(radiance.z(0.8 * irradiance / pi)), 4) << radiance.mean() << " +- " << radiance.standard_error();
}

} // namespace
} // namespace scree
