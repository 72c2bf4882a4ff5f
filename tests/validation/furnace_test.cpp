// The white furnace: lossless grains in a constant environment of radiance 1 are invisible, whatever their shape,
// roughness and overlap, and however long the paths. Every error in a weight (n^2, Fresnel, roulette) shows here.

#include "render/integrators/path_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <mutex>

namespace scree {
namespace {

struct Furnace {
    Estimate radiance;
    uint64_t segments = 0, leaks = 0, non_finite = 0;
    uint32_t longest = 0;
};

/// Paths from all sides towards the scene's middle.
Furnace run_furnace(const TestScene& scene, uint32_t paths, const PathOptions& options = {})
{
    Furnace total;
    std::mutex mutex;
    std::vector<double> values(paths);
    tbb::parallel_for(uint32_t{0}, paths, [&](uint32_t p) {
        flush_subnormals();
        Sampler sampler(17, p, 0, 0);
        const double z = 2 * sampler.next() - 1, phi = 2 * pi * sampler.next(), r = std::sqrt(1 - z * z);
        const V3d o = 3.0 * V3d(r * std::cos(phi), r * std::sin(phi), z);
        const V3d target(sampler.next() - 0.5, sampler.next() - 0.5, sampler.next() - 0.5);
        const PathResult path =
            trace_path(scene.world(), scene.tracer(), o, (target - o).normalized(), sampler, options);
        values[p] = path.radiance.x;
        const std::lock_guard lock(mutex);
        total.segments += path.segments;
        total.leaks += path.leaks;
        total.longest = std::max(total.longest, path.segments);
        total.non_finite += !std::isfinite(path.radiance.x);
    });
    for (const double value : values) total.radiance.add(value);
    return total;
}

void expect_white(const Furnace& f, const std::string& name)
{
    EXPECT_EQ(f.non_finite, 0u) << name;
    EXPECT_LT(std::abs(f.radiance.z(1)), 4)
        << name << ": " << f.radiance.mean() << " +- " << f.radiance.standard_error();
    EXPECT_NEAR(f.radiance.mean(), 1, 0.001) << name;
    testing::Test::RecordProperty(name + " longest path", std::to_string(f.longest));
    std::printf("%-34s mean %.7f +- %.1e, %.0f segments a path, longest %u, %llu lost of %llu segments\n", name.c_str(),
                f.radiance.mean(), f.radiance.count() > 1 ? f.radiance.standard_error() : 0.0,
                static_cast<double>(f.segments) / static_cast<double>(f.radiance.count()), f.longest,
                static_cast<unsigned long long>(f.leaks), static_cast<unsigned long long>(f.segments));
}

/// 20,000 grains of radii 0.5..1 that overlap by up to 9 % of the smaller radius.
const std::vector<PackedSphere>& bed()
{
    static const auto spheres = push_apart(20000, 0.62, 0.5, 0.09, 5);
    return spheres;
}

TEST(Furnace, BedOverlapsAsRealDumpsDo)
{
    const double worst = largest_overlap(bed(), packing_edge(bed(), 0.62));
    EXPECT_LE(worst, 0.09);
    EXPECT_GT(worst, 0.06);
}

struct FurnaceCase {
    std::string name;
    Material material;
    int mesh_level; // -1: the sphere itself; 99: a cube
    uint32_t paths;
};

void PrintTo(const FurnaceCase& c, std::ostream* out) { *out << c.name; }

class GrainFurnace : public testing::TestWithParam<FurnaceCase> {};

// A constant light is found only by scattering: every path must return exactly 1.
TEST_P(GrainFurnace, IsWhite)
{
    const FurnaceCase& c = GetParam();
    TestScene scene;
    const uint32_t type = c.mesh_level == 99  ? scene.add_type(c.material, cube())
                          : c.mesh_level >= 0 ? scene.add_type(c.material, icosphere(c.mesh_level))
                                              : scene.add_type(c.material);
    scene.add_grains(bed(), type);
    scene.add_constant_light(1);
    scene.build();
    const Furnace f = run_furnace(scene, c.paths);
    expect_white(f, c.name);
    EXPECT_LT(static_cast<double>(f.leaks), 1e-4 * static_cast<double>(f.segments));
}

INSTANTIATE_TEST_SUITE_P(Types, GrainFurnace,
                         testing::Values(FurnaceCase{"smooth glass spheres", dielectric(1.5), -1, 20000},
                                         FurnaceCase{"rough glass spheres", dielectric(1.5, 0.3), -1, 4000},
                                         FurnaceCase{"smooth glass mesh", dielectric(1.5), 3, 4000},
                                         FurnaceCase{"rough glass mesh", dielectric(1.5, 0.3), 2, 2000},
                                         FurnaceCase{"glass cubes", dielectric(1.5), 99, 2000},
                                         FurnaceCase{"dense glass 4", dielectric(4), -1, 2000},
                                         FurnaceCase{"thin glass 1.0001", dielectric(1.0001), -1, 2000},
                                         FurnaceCase{"bubbles in water 0.75", dielectric(0.75), -1, 2000},
                                         FurnaceCase{"white spheres", lambert(1), -1, 2000},
                                         FurnaceCase{"white mesh", lambert(1), 2, 2000}));

Light white_environment()
{
    Light light;
    light.kind = LightKind::environment;
    light.map = std::make_shared<EnvironmentMap>(std::vector<Color>(16 * 8, Color(1)), 16, 8, V3d(0, 0, 1), Color(1));
    return light;
}

// The same light as an environment map, which is sampled: now the values and densities of the rough BSDF must agree
// with its sampled directions. Standard errors 0.008, 0.04 and 0; a normalisation error of 3 % (of a single event: 1 %)
// is found.
TEST(SampledFurnace, RoughGrainsAreWhiteByEveryStrategy)
{
    for (const DirectLight strategy : {DirectLight::both, DirectLight::lights_only, DirectLight::scattering_only}) {
        TestScene scene;
        scene.add_grains(bed(), scene.add_type(dielectric(1.5, 0.5)));
        scene.add_light(white_environment());
        scene.build();
        PathOptions options;
        options.direct_light = strategy;
        const Furnace f = run_furnace(scene, 8000, options);
        EXPECT_LT(std::abs(f.radiance.z(1)), 4) << f.radiance.mean() << " +- " << f.radiance.standard_error();
        EXPECT_LT(f.radiance.standard_error(), strategy == DirectLight::lights_only ? 0.06 : 0.01);
        std::printf("strategy %d: %.5f +- %.5f\n", static_cast<int>(strategy), f.radiance.mean(),
                    f.radiance.standard_error());
    }
}

// Mixed types, a surface that cuts through the bed, a glass box around a part of it: everything is lossless.
TEST(Furnace, MixedSceneIsWhite)
{
    TestScene scene;
    const uint32_t types[] = {scene.add_type(dielectric(1.5)), scene.add_type(dielectric(1.31), icosphere(2)),
                              scene.add_type(lambert(1), cube()), scene.add_type(dielectric(1.5, 0.2))};
    for (size_t i = 0; i < bed().size(); ++i) scene.add_grain(bed()[i].center, bed()[i].radius, types[i % 4]);
    scene.add_surface(ground(60, 3.3), lambert(1));
    TriangleMesh box = cube();
    for (V3d& p : box.positions) p *= 7.5;
    scene.add_surface(box, dielectric(1.33));
    scene.add_constant_light(1);
    scene.build();
    expect_white(run_furnace(scene, 3000), "mixed");
}

// No path leaves a closed room of white walls: a path that leaks between two walls would return light.
TEST(ClosedRoom, LetsNoLightIn)
{
    for (const double half : {1.0, 17.3, 20.0}) {
        TestScene scene;
        TriangleMesh room = cube();
        for (V3d& p : room.positions) p *= half;
        scene.add_surface(room, lambert(0.999f));
        scene.add_constant_light(1e6f);
        scene.build();
        double brought = 0;
        uint64_t segments = 0;
        for (uint32_t p = 0; p < 2000; ++p) {
            Sampler sampler(41, p, 0, 0);
            const V3d d = V3d(sampler.next() - 0.5, sampler.next() - 0.5, sampler.next() - 0.5).normalized();
            const PathResult path = trace_path(scene.world(), scene.tracer(), V3d(0.1, 0.2, 0.3), d, sampler);
            brought += path.radiance.x;
            segments += path.segments;
        }
        EXPECT_EQ(brought, 0) << half;
        EXPECT_GT(segments, 500000u);
    }
}

} // namespace
} // namespace scree
