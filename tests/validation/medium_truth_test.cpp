// Homogeneous media against exact solutions of the transport equation (van de Hulst 1980, Multiple Light Scattering),
// and against themselves, as the result must not depend on the sampling strategy or the unit of length.

#include "render/integrators/path_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/slabs.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr double systematic = 1e-3; // allowed bias of the slabs

void expect_truth(const Estimate& estimate, double truth, const std::string& what)
{
    EXPECT_LT(std::abs(estimate.mean() - truth), 4 * estimate.standard_error() + systematic * truth)
        << what << ": " << estimate.mean() << " +- " << estimate.standard_error() << ", exactly " << truth;
    std::printf("%-40s %.5f +- %.5f, exactly %.5f (%+.2f %%)\n", what.c_str(), estimate.mean(),
                estimate.standard_error(), truth, 100 * (estimate.mean() / truth - 1));
}

constexpr uint32_t paths = 400000;

TEST(HalfSpace, ReflectsWhatTheoryKnows)
{
    const auto shallow = slab(150, V3d(1), Color(0.9f), 0), deep = slab(500, V3d(1), Color(0.99f), 0);
    expect_truth(shine(*shallow, 4 * paths, 1, 1).up[0], 0.41495, "half-space 0.9, normal");
    expect_truth(shine(*shallow, paths, -1, 2).up[0], 0.47802, "half-space 0.9, diffuse");
    expect_truth(shine(*deep, paths / 4, 1, 3).up[0], 0.75272, "half-space 0.99, normal");
    expect_truth(shine(*deep, paths / 4, -1, 4).up[0], 0.79456, "half-space 0.99, diffuse");
}

TEST(Slab, ReflectsAndPassesWhatTheoryKnows)
{
    const ReflectedAndPassed thin = shine(*slab(2, V3d(1), Color(0.9f), 0.75), 10 * paths, 1, 5);
    expect_truth(thin.up[0], 0.09739, "slab g 0.75, albedo 0.9, tau 2: R");
    expect_truth(thin.down[0], 0.66096, "slab g 0.75, albedo 0.9, tau 2: T");
    const ReflectedAndPassed thick = shine(*slab(10, V3d(1), Color(1), 0), 2 * paths, 1, 6);
    expect_truth(thick.up[0], 0.85300, "slab g 0, albedo 1, tau 10: R");
    expect_truth(thick.down[0], 0.14700, "slab g 0, albedo 1, tau 10: T");
}

TEST(Slab, DoesNotKnowTheUnitOfLength)
{
    const ReflectedAndPassed one = shine(*slab(2, V3d(1), Color(0.9f), 0.75), 2000, 0.8, 7);
    const double scale = std::ldexp(1.0, 20);
    const ReflectedAndPassed large = shine(*slab(2 * scale, V3d(1 / scale), Color(0.9f), 0.75), 2000, 0.8, 7);
    EXPECT_EQ(one.up[0].mean(), large.up[0].mean());
    EXPECT_EQ(one.down[0].mean(), large.down[0].mean());
    for (const double unit : {1e-6, 1e6})
        expect_truth(shine(*slab(2 * unit, V3d(1 / unit), Color(0.9f), 0.75), paths, 1, 8).down[0], 0.66096,
                     "slab in another unit: T");
}

TEST(Slab, IsTheSameAsAGrid)
{
    for (const double unit : {1.0, 1e-6, 1e6}) {
        const GridSlab slab(2, 1, 0.9f, 0.75, unit);
        const ReflectedAndPassed sum = shine(slab.world, *slab.tracer, 2 * unit, paths, 1, 21);
        expect_truth(sum.up[0], 0.09739, "grid, g 0.75, albedo 0.9, tau 2: R");
        expect_truth(sum.down[0], 0.66096, "grid, g 0.75, albedo 0.9, tau 2: T");
    }
    const GridSlab thick(10, 1, 1, 0, 1);
    expect_truth(shine(thick.world, *thick.tracer, 10, paths / 4, 1, 22).down[0], 0.14700,
                 "grid, g 0, albedo 1, tau 10: T");
}

TEST(Slab, IsTheSumOfTwoThatTouch)
{
    for (const bool grey : {true, false}) { // one grey medium, or two media that add up in one box
        TestScene scene;
        const double wide = 6e3;
        if (grey) {
            scene.add_medium(box_mesh({-wide, -wide, -2}, {wide, wide, -1}), V3d(1), Color(0.9f), 0.75);
            scene.add_medium(box_mesh({-wide, -wide, -1}, {wide, wide, 0}), V3d(1), Color(0.9f), 0.75);
        } else {
            for (const double sigma_t : {0.25, 0.75})
                scene.add_medium(box_mesh({-wide, -wide, -2}, {wide, wide, 0}), V3d(sigma_t), Color(0.9f), 0.75);
        }
        scene.add_constant_light(1);
        scene.build();
        const ReflectedAndPassed sum = shine(scene, paths, 1, 31);
        expect_truth(sum.up[0], 0.09739, grey ? "two slabs that touch: R" : "two slabs in one: R");
        expect_truth(sum.down[0], 0.66096, grey ? "two slabs that touch: T" : "two slabs in one: T");
    }
}

TEST(Slab, ChannelsThatSeeItDifferentlyAreEachRight)
{
    // tau 2, 10 and 0.1; the single channels are known from above or from separate walks.
    const ReflectedAndPassed all = shine(*slab(1, V3d(2, 10, 0.1), Color(0.9f, 1, 0.9f), 0), paths, 1, 9);
    for (int c = 0; c < 3; ++c) {
        const ReflectedAndPassed own = shine(*slab(1,
                                                   V3d(c == 0   ? 2
                                                       : c == 1 ? 10
                                                                : 0.1),
                                                   Color(c == 1 ? 1 : 0.9f), 0),
                                             paths, 1, 10);
        for (const bool up : {false, true}) {
            const Estimate &a = up ? all.up[c] : all.down[c], &b = up ? own.up[0] : own.down[0];
            EXPECT_LT(std::abs(a.mean() - b.mean()), 4 * std::hypot(a.standard_error(), b.standard_error()))
                << c << " " << up << ": " << a.mean() << " " << b.mean();
        }
    }
}

TEST(Slab, EndsWhateverItsDensity)
{
    for (const double g : {-0.99, 0.0, 0.99}) {
        for (const double sigma_t : {0.0, 1e-12, 1e-3, 1.0, 1e3, 1e12}) {
            for (const float albedo : {0.999f, 1.0f}) {
                const ReflectedAndPassed sum = shine(*slab(1, V3d(sigma_t), Color(albedo), g), 300, 0.5, 11);
                const double all = sum.up[0].mean() + sum.down[0].mean();
                EXPECT_TRUE(std::isfinite(all) && all > 0 && all <= 1 + 1e-6) << g << " " << sigma_t << " " << all;
                if (albedo == 1) {
                    EXPECT_NEAR(all, 1, 1e-6) << g << " " << sigma_t; // nothing is lost
                }
                if (sigma_t <= 1e-12) {
                    EXPECT_EQ(sum.down[0].mean(), 1);
                }
            }
            if (sigma_t == 0) continue;
            const GridSlab grid(1, sigma_t, 1, g, 1);
            const ReflectedAndPassed sum = shine(grid.world, *grid.tracer, 1, 300, 0.5, 12);
            EXPECT_NEAR(sum.up[0].mean() + sum.down[0].mean(), 1, 1e-6) << "grid " << g << " " << sigma_t;
        }
    }
}

TEST(MediumFurnace, IsWhiteAfterAHundredThousandScatterings)
{
    TestScene scene; // optical radius 500, seen from its middle: about 500^2 (1 - g) / 2 scatterings
    scene.add_medium(icosphere(3), V3d(500), Color(1), 0.3);
    scene.add_constant_light(1);
    scene.build();
    Estimate events;
    for (uint32_t p = 0; p < 50; ++p) {
        Sampler sampler(3, p, 0, 0);
        const PathResult result =
            trace_path(scene.world(), scene.tracer(), V3d(0), V3d(0.1, 0, 1).normalized(), sampler, {});
        EXPECT_EQ(result.radiance.x, 1);
        EXPECT_EQ(result.leaks, 0u);
        events.add(result.events);
    }
    EXPECT_GT(events.mean(), 60000);
    std::printf("scatterings of a path: %.0f\n", events.mean());
}

/// Expects radiance 1 with every strategy in the white scene that `add` makes.
template <class Add>
void expect_white(const Add& add, const std::string& what)
{
    TestScene constant, sampled;
    add(constant);
    add(sampled);
    constant.add_constant_light(1);
    sampled.add_white_environment();
    constant.build();
    sampled.build();
    EXPECT_NEAR(from_all_around(constant.world(), constant.tracer(), 20000, 4, {}, 5).mean(), 1, 1e-6) << what;
    for (const DirectLight strategy : {DirectLight::both, DirectLight::lights_only, DirectLight::scattering_only}) {
        PathOptions options;
        options.direct_light = strategy;
        const Estimate e = from_all_around(sampled.world(), sampled.tracer(), 100000, 4, options, 6);
        EXPECT_LT(std::abs(e.z(1)), 4) << what << ", strategy " << static_cast<int>(strategy) << ": " << e.mean()
                                       << " +- " << e.standard_error();
        std::printf("%s, strategy %d: %.5f +- %.5f\n", what.c_str(), static_cast<int>(strategy), e.mean(),
                    e.standard_error());
    }
}

/// A medium with grains and a glass surface in it, and another medium that overlaps it.
void add_everything(TestScene& scene)
{
    const uint32_t glass = scene.add_type(dielectric(1.5)), white = scene.add_type(lambert(1));
    scene.add_grain({0.1, 0, 0}, 0.3, glass);
    scene.add_grain({-0.6, 0.2, 0.1}, 0.2, white);
    scene.add_grain({0.6, 0.75, 0.1}, 0.3, white); // through the medium's surface
    TriangleMesh pane = box_mesh({-0.9, -0.9, -0.6}, {0.4, 0.5, -0.5});
    scene.add_surface(pane, dielectric(1.33));
    scene.add_medium(cube(), V3d(3), Color(1), 0.6);
    TriangleMesh ball = icosphere(2);
    for (V3d& p : ball.positions) p = 0.7 * p + V3d(0.5, 0.2, -0.4);
    scene.add_medium(ball, V3d(5), Color(1), -0.3);
}

TEST(MediumFurnace, IsWhiteWithGrainsAndSurfacesAndMediaInEachOther)
{
    expect_white(add_everything, "all in each other");
}

TEST(MediumFurnace, IsWhiteWhereFacesCoincide)
{
    // On a white floor, under a glass box of the same size, and against another medium.
    expect_white(
        [](TestScene& scene) {
            scene.add_medium(box_mesh({-1, -1, 0}, {0, 1, 1}), V3d(4), Color(1), 0.5);
            scene.add_medium(box_mesh({0, -1, 0}, {1, 1, 1}), V3d(9), Color(1), -0.2);
            scene.add_surface(ground(3, 0), lambert(1));
            scene.add_surface(box_mesh({0, -1, 0}, {1, 1, 1}), dielectric(1.3));
        },
        "faces coincide");
}

TEST(MediumLight, StrategiesAgree)
{
    TestScene scene;
    scene.add_medium(cube(), V3d(2, 3, 5), Color(0.9f, 0.95f, 1), 0.5);
    scene.add_light(rectangle_light(V3d(-1, -1, 2), V3d(2, 0, 0), V3d(0, 2, 0)));
    scene.add_light(sphere_light(V3d(0.3, 0.2, 0.1), 0.2, 2));
    scene.build();
    std::vector<Estimate> found;
    for (const DirectLight strategy : {DirectLight::both, DirectLight::lights_only, DirectLight::scattering_only}) {
        PathOptions options;
        options.direct_light = strategy;
        found.push_back(from_all_around(scene.world(), scene.tracer(), 200000, 4, options, 3 + found.size()));
        std::printf("strategy %d: %.5f +- %.5f\n", static_cast<int>(strategy), found.back().mean(),
                    found.back().standard_error());
    }
    for (size_t i = 1; i < 3; ++i) {
        EXPECT_LT(std::abs(found[0].mean() - found[i].mean()),
                  4 * std::hypot(found[0].standard_error(), found[i].standard_error()));
    }
}

} // namespace
} // namespace scree
