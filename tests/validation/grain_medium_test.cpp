// A medium that replaces grains: its numbers, no loss of light between grains and medium, and unchanged images.

#include "base/warp.h"
#include "mixtures/checkerboard_mixture.h"
#include "render/build/grain_medium.h"
#include "render/equivalent/walk_bed.h"
#include "render/integrators/path_tracer.h"
#include "render/media/homogeneous_medium.h"
#include "tests/builders/grain_beds.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"
#include "tests/builders/tile_beds.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

namespace scree {
namespace {

std::shared_ptr<const Gsdf> gsdf_of(const Material& material)
{
    Material lossless = material;
    lossless.absorption = Color(0);
    if (material.kind == MaterialKind::lambert) lossless.reflectance = Color(1);
    return build_gsdf({nullptr, lossless}, {0.05});
}

TEST(PackingSample, SharesKeepSumsOfPowersOfTheRadius)
{
    TestScene scene;
    Material tea = dielectric(1.5);
    tea.absorption = Color(0.1f, 0.3f, 1);
    scene.set_gsdf(scene.add_type(tea), gsdf_of(tea));
    scene.set_gsdf(scene.add_type(lambert(0.8f)), gsdf_of(lambert(0.8f)));
    PackingSample sample;
    std::array<double, 5> sums{};
    for (uint64_t i = 0; i < 1000; ++i) {
        const double r = 0.5 + 0.003 * static_cast<double>(i % 700);
        sample.grains.push_back({i, r, static_cast<uint8_t>(i % 3 == 0)});
        for (size_t k = 2; k < 5; ++k) sums[k] += std::pow(r, static_cast<double>(k));
    }
    std::array<double, 5> kept{};
    const MomentTable table(scene.world().types, sample);
    for (const GrainShare& share : shares_of(sample, table)) {
        EXPECT_GT(share.radius, 0);
        ASSERT_TRUE(share.albedo);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(share.albedo->weight[c], grain_albedo(*share.gsdf, share.material, share.radius).weight[c],
                        1e-3);
        for (size_t k = 2; k < 5; ++k) kept[k] += share.number * std::pow(share.radius, static_cast<double>(k));
    }
    for (size_t k = 2; k < 5; ++k) EXPECT_NEAR(kept[k] / sums[k], 1, 1e-12) << k;
}

TEST(WalkLike, FindsTheFormulaInAThinMixtureOfTypesAndSizes)
{
    TestScene scene; // large glass and small white grains: confusing the two would show
    scene.set_gsdf(scene.add_type(dielectric(1.5)), gsdf_of(dielectric(1.5)));
    scene.set_gsdf(scene.add_type(lambert(0.8f)), gsdf_of(lambert(0.8f)));
    PackingSample sample;
    for (uint64_t i = 0; i < 1000; ++i)
        sample.grains.push_back({i, i % 4 == 0 ? 2.0 : 1.0, static_cast<uint8_t>(i % 4 != 0)});
    sample.pack_rate = 0.01;
    const MomentTable table(scene.world().types, sample);
    const MixtureMoments moments = mixture_moments(shares_of(sample, table), sample.pack_rate);
    const PackingWalk walk = walk_like(scene.world(), sample, {}).walk;
    const auto expect_near = [](const Measured& found, double formula, const std::string& what) {
        // At 1 % of the volume grains still hide each other a little: 1 %.
        EXPECT_LT(std::abs(found.value - formula), 4 * found.error + 0.01 * std::abs(formula))
            << what << ": " << found.value << " +- " << found.error << ", by formula " << formula;
        std::printf("%-20s %.4f +- %.4f, by formula %.4f\n", what.c_str(), found.value, found.error, formula);
    };
    expect_near(walk.void_flight, moments.void_flight, "void flight");
    expect_near(walk.cosine, moments.g, "mean cosine");
    expect_near(walk.transport_length, moments.transport_length(), "transport length");
    expect_near(walk.diffusivity, moments.diffusivity(), "diffusivity");
    EXPECT_EQ(walk.left, 0u);
}

/// A world of packed spheres with a medium below `depth` radii.
struct Cored {
    World world;
    std::unique_ptr<Tracer> tracer;
    std::vector<PartReport> parts;

    Cored(const TestScene& scene, double depth, EquivalentForm form = EquivalentForm::formula,
          std::optional<StfForm> shells = {})
        : world(scene.world())
    {
        std::vector<std::string> remarks;
        const auto medium = make_grain_medium(world, form, {});
        replace_grains(*medium, {depth < 0, depth, 0}, world, parts, remarks, {});
        prepare_media(world, shells);
        tracer = std::make_unique<Tracer>(std::make_shared<EmbreeDevice>(), world);
    }
};

Estimate shine_in(const World& world, const Tracer& tracer, uint32_t paths, const PathOptions& options, uint64_t seed)
{
    std::vector<double> values(paths);
    tbb::parallel_for(uint32_t{0}, paths, [&](uint32_t p) {
        flush_subnormals();
        Sampler sampler(seed, p, 0, 0);
        const double u1 = sampler.next(), u2 = sampler.next();
        const V3d o = 3.0 * sample_sphere(u1, u2);
        const V3d target(sampler.next() - 0.5, sampler.next() - 0.5, sampler.next() - 0.5);
        values[p] = trace_path(world, tracer, o, (target - o).normalized(), sampler, options).radiance.x;
    });
    Estimate radiance;
    for (const double value : values) radiance.add(value);
    return radiance;
}

TEST(GrainMediumFurnace, IsWhite)
{
    // Glass and white spheres, a pane of glass through grains and medium; grains near faces are explicit geometry or
    // proxies.
    TestScene constant, sampled;
    for (TestScene* scene : {&constant, &sampled}) {
        const uint32_t glass = scene->add_type(dielectric(1.5)), white = scene->add_type(lambert(1));
        scene->set_gsdf(glass, scene == &constant ? gsdf_of(dielectric(1.5)) : constant.world().types[glass].gsdf);
        scene->set_gsdf(white, scene == &constant ? gsdf_of(lambert(1)) : constant.world().types[white].gsdf);
        uint64_t i = 0;
        for (const PackedSphere& s : push_apart(4000, 0.6, 0.5, 0.05, 5))
            scene->add_grain(s.center, s.radius, i++ % 2 ? glass : white);
    }
    constant.add_constant_light(1);
    sampled.add_white_environment();
    constant.build();
    sampled.build();
    const Cored dark(constant, 2, EquivalentForm::formula, StfForm::full),
        bright(sampled, 2, EquivalentForm::formula, StfForm::full);
    ASSERT_EQ(dark.world.regions.size(), 1u);
    EXPECT_EQ(dark.world.regions[0].medium->uniform(), nullptr); // the medium of a list of grains varies in space
    for (const uint32_t explicit_grains : {0u, all_grains}) {
        PathOptions options;
        options.explicit_grains = explicit_grains;
        uint64_t shells = 0;
        for (uint32_t p = 0; p < 200; ++p) {
            Sampler sampler(19, p, 0, 0);
            shells += trace_path(dark.world, *dark.tracer, V3d(0.01), V3d(0, 0, 1), sampler, options).shells;
        }
        EXPECT_GT(shells, 200u); // paths go through them
        const Estimate plain = shine_in(dark.world, *dark.tracer, 3000, options, 17);
        EXPECT_NEAR(plain.mean(), 1, 1e-5) << explicit_grains;
        for (const DirectLight strategy : {DirectLight::both, DirectLight::lights_only, DirectLight::scattering_only}) {
            if (explicit_grains == all_grains && strategy == DirectLight::lights_only)
                continue; // smooth glass has nothing to sample
            options.direct_light = strategy;
            // With light sampling alone a few paths carry most of the light: fewer paths would give no reliable
            // standard error.
            const uint32_t paths = strategy == DirectLight::lights_only ? 400000 : 20000;
            const Estimate e = shine_in(bright.world, *bright.tracer, paths, options, 18);
            EXPECT_LT(std::abs(e.z(1)), 4) << explicit_grains << " as they are, strategy " << static_cast<int>(strategy)
                                           << ": " << e.mean() << " +- " << e.standard_error();
            std::printf("strategy %d: %.5f +- %.5f\n", static_cast<int>(strategy), e.mean(), e.standard_error());
        }
    }
}

TEST(GrainMedium, LeavesPicturesOfBedsAsTheyAre)
{
    // 1.3 %: the promised 1 % plus 4 standard errors of 60,000 paths.
    for (const BedGrain& grain : bed_grains(0.05)) {
        if (grain.name == "glass cubes" || grain.name == "flour") continue; // similar to sugar and white spheres
        const auto bed = make_bed(grain, 0.6, 6000);
        const Cored cored(*bed, 4, EquivalentForm::decay);
        ASSERT_EQ(cored.world.regions.size(), 1u) << grain.name;
        PathOptions options;
        options.explicit_grains = 0;
        const Estimate all = shine_in(bed->world(), bed->tracer(), 60000, options, 1),
                       some = shine_in(cored.world, *cored.tracer, 60000, options, 2);
        const double error = std::hypot(all.standard_error(), some.standard_error());
        EXPECT_LT(std::abs(some.mean() - all.mean()), 0.01 * all.mean() + 4 * error) << grain.name;
        std::printf("%-20s all grains %.5f, medium below 4 r %+.2f %% +- %.2f\n", grain.name.c_str(), all.mean(),
                    100 * (some.mean() / all.mean() - 1), 100 * error / all.mean());
    }
}

TEST(GrainMedium, OfAFillVariesAsItsMixtureDoes)
{
    const auto make = [](bool patterned) {
        World world;
        TriangleMesh mesh = cube();
        for (V3d& p : mesh.positions) p *= 40;
        const auto fill = std::make_shared<ProceduralFill>(std::make_shared<const Domain>(mesh, "cube"),
                                                           sphere_tile(0.5, 500), FillOptions{1, 0});
        CheckerboardMixture::Board board;
        board.cell = Imath::V3d(patterned ? 40 : 1e9);
        board.offset = Imath::V3d(patterned ? 0 : -5e8);
        world.types = {{"glass", dielectric(1.5), nullptr, gsdf_of(dielectric(1.5))},
                       {"white", lambert(0.5f), nullptr, gsdf_of(lambert(0.5f))}};
        world.fill = std::make_shared<GrainFill>(
            fill, std::make_shared<CheckerboardMixture>(board, std::vector<uint32_t>{0, 1}, V3d(0)), world.space);
        world.domain = fill->domain().bounds();
        std::vector<PartReport> parts;
        std::vector<std::string> remarks;
        const auto medium = make_grain_medium(world, EquivalentForm::formula, {});
        replace_grains(*medium, {false, 4, 0}, world, parts, remarks, {});
        return world;
    };
    const World same = make(false), board = make(true);
    ASSERT_EQ(same.regions.size(), 1u);
    ASSERT_NE(same.regions[0].medium->uniform(), nullptr);
    ASSERT_EQ(board.regions.size(), 1u);
    ASSERT_EQ(board.regions[0].medium->uniform(), nullptr);
    // In the middles of the cells there is one type only: the medium is that type's homogeneous medium.
    const Medium& grid = *board.regions[0].medium;
    const std::array<double, 2> albedo{grid.albedo({20, 20, 20}).x, grid.albedo({-20, 20, 20}).x};
    EXPECT_NEAR(std::max(albedo[0], albedo[1]), 1, 1e-5);
    EXPECT_NEAR(std::min(albedo[0], albedo[1]), 0.5, 1e-5);
    const double inner = same.regions[0].medium->uniform()->albedo().x;
    EXPECT_TRUE(inner == 1 || std::abs(inner - 0.5) < 1e-5) << inner;
}

} // namespace
} // namespace scree
