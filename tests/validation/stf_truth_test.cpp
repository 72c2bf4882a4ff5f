// Shell tracing against exact solutions of the transport equation, against walks from scattering to scattering, and in
// white furnaces.

#include "render/media/grid_medium_build.h"
#include "tests/builders/shapes.h"
#include "tests/builders/slabs.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr double systematic = 5e-3; // allowed bias of a slab with shells

void expect_truth(const Estimate& estimate, double truth, const std::string& what)
{
    EXPECT_LT(std::abs(estimate.mean() - truth), 4 * estimate.standard_error() + systematic * truth)
        << what << ": " << estimate.mean() << " +- " << estimate.standard_error() << ", exactly " << truth;
    std::printf("%-44s %.5f +- %.5f, exactly %.5f (%+.2f %%)\n", what.c_str(), estimate.mean(),
                estimate.standard_error(), truth, 100 * (estimate.mean() / truth - 1));
}

void expect_equal(const Estimate& a, const Estimate& b, double off, const std::string& what)
{
    EXPECT_LT(std::abs(a.mean() - b.mean()), 4 * std::hypot(a.standard_error(), b.standard_error()) + off * b.mean())
        << what << ": " << a.mean() << " +- " << a.standard_error() << ", " << b.mean() << " +- " << b.standard_error();
}

constexpr uint32_t paths = 200'000;

TEST(ShellTracing, HalfSpacesReflectWhatTheoryKnows)
{
    const auto shallow = slab(150, V3d(1), Color(0.9f), 0, StfForm::full),
               deep = slab(500, V3d(1), Color(0.99f), 0, StfForm::full);
    expect_truth(shine(*shallow, paths, 1, 1).up[0], 0.41495, "half-space 0.9, normal");
    expect_truth(shine(*shallow, paths, -1, 2).up[0], 0.47802, "half-space 0.9, diffuse");
    expect_truth(shine(*deep, paths, 1, 3).up[0], 0.75272, "half-space 0.99, normal");
    expect_truth(shine(*deep, paths, -1, 4).up[0], 0.79456, "half-space 0.99, diffuse");
}

TEST(ShellTracing, SlabsReflectAndPassWhatTheoryKnows)
{
    const ReflectedAndPassed thin = shine(*slab(2, V3d(1), Color(0.9f), 0.75, StfForm::full), 4 * paths, 1, 5);
    expect_truth(thin.up[0], 0.09739, "slab g 0.75, albedo 0.9, tau 2: R");
    expect_truth(thin.down[0], 0.66096, "slab g 0.75, albedo 0.9, tau 2: T");
    const ReflectedAndPassed thick = shine(*slab(10, V3d(1), Color(1), 0, StfForm::full), 2 * paths, 1, 6);
    expect_truth(thick.up[0], 0.85300, "slab g 0, albedo 1, tau 10: R");
    expect_truth(thick.down[0], 0.14700, "slab g 0, albedo 1, tau 10: T");
    const GridSlab grid(10, 1, 1, 0, 1, StfForm::full);
    ASSERT_NE(grid.world.regions[0].shells, nullptr);
    expect_truth(shine(grid.world, *grid.tracer, 10, paths, 1, 7).down[0], 0.14700, "the same as a grid: T");
}

TEST(ShellTracing, ThickSlabsAreAsWithoutShells)
{
    for (const double g : {0.0, 0.8}) {
        const Color albedo(0.9f, 0.99f, 1);
        const ReflectedAndPassed shells = shine(*slab(60, V3d(1), albedo, g, StfForm::full), paths, 1, 8),
                                 events = shine(*slab(60, V3d(1), albedo, g), paths / 8, 1, 9);
        for (int c = 0; c < 3; ++c) {
            expect_equal(shells.up[c], events.up[c], systematic, "R");
            expect_equal(shells.down[c], events.down[c], systematic, "T");
        }
        std::printf("tau 60, g %g: R %.4f %.4f %.4f, T %.5f; from event to event %.4f %.4f %.4f, %.5f\n", g,
                    shells.up[0].mean(), shells.up[1].mean(), shells.up[2].mean(), shells.down[2].mean(),
                    events.up[0].mean(), events.up[1].mean(), events.up[2].mean(), events.down[2].mean());
    }
}

TEST(ShellTracing, DoesNotKnowTheUnitOfLength)
{
    const double scale = 0x1p20;
    const ReflectedAndPassed one = shine(*slab(20, V3d(1), Color(0.99f), 0.5, StfForm::full), 3000, 0.8, 7);
    const ReflectedAndPassed large =
        shine(*slab(20 * scale, V3d(1 / scale), Color(0.99f), 0.5, StfForm::full), 3000, 0.8, 7);
    EXPECT_EQ(one.up[0].mean(), large.up[0].mean());
    EXPECT_EQ(one.down[0].mean(), large.down[0].mean());
}

TEST(ShellTracing, IsWhiteInAFurnaceInEveryForm)
{
    for (const StfForm form :
         {StfForm::full, StfForm::cosine, StfForm::hg, StfForm::interpolated, StfForm::diffusion}) {
        TestScene constant, sampled;
        for (TestScene* scene : {&constant, &sampled}) {
            scene->add_medium(cube(), V3d(25), Color(1), 0.6);
            scene->add_surface(box_mesh({-0.9, -0.9, -0.6}, {0.4, 0.5, -0.5}), dielectric(1.33));
            TriangleMesh ball = icosphere(2);
            for (V3d& p : ball.positions) p = 0.7 * p + V3d(0.5, 0.2, -0.4);
            // Through the cube's faces: where both media overlap, light goes from event to event.
            scene->add_medium(ball, V3d(12), Color(1), -0.3);
            scene->use_shells(form);
        }
        constant.add_constant_light(1);
        sampled.add_white_environment();
        constant.build();
        sampled.build();
        ASSERT_NE(constant.world().regions[0].shells, nullptr);
        EXPECT_NEAR(from_all_around(constant.world(), constant.tracer(), 20'000, 4, {}, 5).mean(), 1, 1e-5);
        for (const DirectLight strategy : {DirectLight::both, DirectLight::lights_only, DirectLight::scattering_only}) {
            PathOptions options;
            options.direct_light = strategy;
            const Estimate e = from_all_around(sampled.world(), sampled.tracer(), 30'000, 4, options, 6);
            // With scattering alone the result is 1 up to rounding; with light sampling, records have the error of
            // their scatterings near the shell.
            const double off = strategy == DirectLight::scattering_only ? 1e-5 : systematic;
            EXPECT_LT(std::abs(e.mean() - 1), 4 * e.standard_error() + off)
                << stf_form_names[form] << ", strategy " << static_cast<int>(strategy);
            std::printf("%s, strategy %d: %.5f +- %.5f\n", stf_form_names[form].c_str(), static_cast<int>(strategy),
                        e.mean(), e.standard_error());
        }
    }
}

TEST(ShellTracing, FindsLightByEveryStrategyAsVolumetricPathTracingDoes)
{
    std::vector<Estimate> found;
    for (const bool shells : {false, true}) {
        TestScene scene;
        scene.add_medium(icosphere(3), V3d(30), Color(0.99f, 0.999f, 1), 0.5);
        scene.add_light(rectangle_light(V3d(-0.5, -0.5, 1.5), V3d(1, 0, 0), V3d(0, 1, 0), 5));
        scene.add_light(distant_light(V3d(-1, 0.3, -0.2), 0.02, 2));
        if (shells) scene.use_shells();
        scene.build();
        for (const DirectLight strategy : {DirectLight::both, DirectLight::lights_only, DirectLight::scattering_only}) {
            PathOptions options;
            options.direct_light = strategy;
            found.push_back(from_all_around(scene.world(), scene.tracer(), shells ? 150'000 : 60'000, 4, options,
                                            3 + found.size()));
            std::printf("shells %d, strategy %d: %.5f +- %.5f\n", shells, static_cast<int>(strategy),
                        found.back().mean(), found.back().standard_error());
        }
    }
    for (size_t i = 1; i < found.size(); ++i)
        expect_equal(found[i], found[0], systematic, "strategy " + std::to_string(i % 3));
}

TEST(ShellTracing, WeighsLightByThePhaseFunctionThatRecordsAreDrawnFrom)
{
    // Nearly all light is scattered within 36 degrees of forwards or backwards. Looking from the middle, where shells
    // are largest, with the sun behind the viewer, the table has five times the density of the Henyey-Greenstein phase
    // function with the same mean cosine, 0, which the last two forms use instead. When light was sampled with one and
    // directions were drawn from the other, the first two strategies gave 0.066 and 0.026.
    CosineTable bins;
    for (uint32_t i = 0; i < CosineTable::bins; ++i) {
        const double cosine = (i + 0.5) * CosineTable::width() - 1;
        bins.density[i] = 0.05 + (std::abs(cosine) > 0.8125 ? 2.4 : 0);
    }
    const auto table = std::make_shared<const PhaseTable>(bins);
    for (const StfForm form : {StfForm::full, StfForm::cosine, StfForm::hg, StfForm::interpolated}) {
        TestScene scene;
        scene.add_medium(icosphere(3), V3d(2.5), Color(0.5f), table);
        scene.add_light(distant_light(V3d(0, 0, 1), 0.1, 10));
        scene.use_shells(form);
        scene.build();
        ASSERT_NE(scene.world().regions[0].shells, nullptr);
        std::vector<Estimate> found;
        for (const DirectLight strategy : {DirectLight::lights_only, DirectLight::scattering_only, DirectLight::both}) {
            PathOptions options;
            options.direct_light = strategy;
            Estimate& radiance = found.emplace_back();
            for (uint32_t p = 0; p < 50'000; ++p) {
                Sampler sampler(5 + found.size(), p, 0, 0);
                radiance.add(
                    trace_path(scene.world(), scene.tracer(), V3d(0), V3d(0, 0, -1), sampler, options).radiance.x);
            }
            std::printf("%s, strategy %d: %.5f +- %.5f\n", stf_form_names[form].c_str(), static_cast<int>(strategy),
                        radiance.mean(), radiance.standard_error());
        }
        for (size_t i = 1; i < found.size(); ++i) expect_equal(found[i], found[0], systematic, stf_form_names[form]);
    }
}

TEST(ShellTracing, EndsWhateverTheDensity)
{
    for (const double g : {-0.99, 0.0, 0.99}) {
        for (const double sigma_t : {1e-12, 1.0, 1e3, 1e4}) {
            const ReflectedAndPassed sum = shine(*slab(1, V3d(sigma_t), Color(1), g, StfForm::full), 200, 0.5, 11);
            EXPECT_NEAR(sum.up[0].mean() + sum.down[0].mean(), 1, 1e-5) << g << " " << sigma_t;
        }
        const ReflectedAndPassed dense = shine(*slab(1, V3d(1e12), Color(0.999f), g, StfForm::full), 200, 0.5, 11);
        EXPECT_TRUE(dense.up[0].mean() > 0.1 && dense.up[0].mean() <= 1) << g;
        EXPECT_EQ(dense.down[0].mean(), 0);
    }
}

} // namespace
} // namespace scree
