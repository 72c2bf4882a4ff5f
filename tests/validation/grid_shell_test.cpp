// Shells in grid media: variation within a shell must not be replaced by its mean.

#include "render/media/grid_medium_build.h"
#include "tests/builders/shapes.h"
#include "tests/builders/slabs.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr int n = 40; // the grid goes from -n to n over the cube -1..1

/// The values of the grids at a voxel.
struct Voxel {
    float density, albedo = 0.99f, g = 0;
};

struct Found {
    Estimate radiance;
    uint64_t shells = 0;
};

/// The mean radiance of a cube of a medium, seen from all sides, with or without shells.
template <class Fill>
Found look(const Fill& fill, const Light& light, bool nearest, bool shells, uint32_t paths)
{
    openvdb::initialize();
    const auto density = openvdb::FloatGrid::create(0), albedo = openvdb::FloatGrid::create(0),
               g = openvdb::FloatGrid::create(0);
    for (int x = -n - 2; x <= n + 2; ++x) {
        for (int y = -n - 2; y <= n + 2; ++y) {
            for (int z = -n - 2; z <= n + 2; ++z) {
                const Voxel voxel = fill(x, y, z);
                density->tree().setValue({x, y, z}, voxel.density);
                albedo->tree().setValue({x, y, z}, voxel.albedo);
                g->tree().setValue({x, y, z}, voxel.g);
            }
        }
    }
    World world;
    MediumGrids grids{density, nullptr, nullptr, {}, "varying"};
    grids.albedo = albedo;
    grids.g = g;
    for (int k = 0; k < 3; ++k) grids.to_scene[k][k] = 1.0 / n;
    const TriangleMesh mesh = cube();
    MediumRegion region{"varying", {}, mesh.triangles, nullptr, nullptr, false};
    for (const V3d& p : mesh.positions) region.positions.emplace_back(p);
    GridMediumOptions options;
    options.nearest = nearest;
    region.medium = std::make_shared<GridMedium>(make_grid_medium(grids, options, {}, {}));
    world.regions.push_back(std::move(region));
    world.lights = LightSet({light}, 2);
    prepare_media(world, shells ? std::optional(StfForm::full) : std::nullopt);
    const Tracer tracer(std::make_shared<EmbreeDevice>(), world);
    Found found{from_all_around(world, tracer, paths, 4, {}, 7 + shells), 0};
    for (uint32_t p = 0; p < 1000; ++p) {
        Sampler sampler(1, p, 0, 0);
        found.shells += trace_path(world, tracer, V3d(0), V3d(1, 0, 0), sampler).shells;
    }
    return found;
}

/// off: the bias allowed. Prints both, and how many shells a path went through.
template <class Fill>
uint64_t expect_equal(const Fill& fill, const Light& light, bool nearest, double off, const char* what)
{
    const Found truth = look(fill, light, nearest, false, 25'000), found = look(fill, light, nearest, true, 40'000);
    const Estimate &a = found.radiance, &b = truth.radiance;
    EXPECT_LT(std::abs(a.mean() - b.mean()), 4 * std::hypot(a.standard_error(), b.standard_error()) + off * b.mean())
        << what;
    std::printf("%-32s %.5f +- %.5f, through shells %.5f +- %.5f, %.1f shells a path\n", what, b.mean(),
                b.standard_error(), a.mean(), a.standard_error(), 1e-3 * static_cast<double>(found.shells));
    return found.shells;
}

Light bright_top()
{
    Light sky;
    sky.kind = LightKind::environment;
    std::vector<Color> texels(16 * 8, Color(0.2f));
    for (size_t i = 0; i < 32; ++i) texels[i] = Color(2);
    sky.map = std::make_shared<EnvironmentMap>(texels, 16, 8, V3d(0, 0, 1), Color(1));
    return sky;
}

Light sun()
{
    Light light;
    light.kind = LightKind::distant;
    light.direction = V3d(0.3, -0.2, 1).normalized();
    light.one_minus_cos = 0.02;
    light.radiance = Color(8);
    return light;
}

TEST(GridShells, FollowDensityAndAlbedoAndAsymmetry)
{
    // Density and asymmetry grow by half over the cube, the albedo falls.
    const auto fill = [](int x, int y, int) {
        const float part = 0.5f * (1 + static_cast<float>(x + y) / (2 * n));
        return Voxel{40 + 20 * part, 0.999f - 0.01f * part, 0.3f + 0.3f * part};
    };
    // Shells are within 5 % of the medium at their centres.
    EXPECT_GT(expect_equal(fill, bright_top(), false, 0.01, "a density that grows"), 3000u); // more than three a path
}

// Checkerboards with 1.9 and 0.1 times a density of 64 per unit; their fields are 12 and 49 mean free paths wide where
// denser. An earlier version used the means and had errors of 6 % and 3 %; 5 % is detected. Shells fit only inside the
// fields.
TEST(GridShells, SeeACheckerboard)
{
    for (const bool nearest : {false, true}) {
        for (const int field : {4, 16}) {
            const auto fill = [field](int x, int y, int z) {
                const auto number = [field](int a) { return (a + 64 * field) / field; };
                return Voxel{(number(x) + number(y) + number(z)) % 2 ? 121.6f : 6.4f};
            };
            expect_equal(fill, bright_top(), nearest, 0.005, nearest ? "a board of voxels" : "a board");
        }
    }
}

// Fields much thinner than a mean free path average out.
TEST(GridShells, DoNotSeeThinFields)
{
    const auto fill = [](int x, int y, int z) { return Voxel{(x + y + z) % 2 ? 12.f : 8.f}; };
    EXPECT_GT(expect_equal(fill, bright_top(), false, 0.005, "fine and thin fields"), 300u);
}

// Dense inside thin: light comes from much nearer than the face of the cube would be at the ball's density, or voxels
// at half their density.
TEST(GridShells, FindTheSunThroughThinSurroundings)
{
    const auto fill = [](int x, int y, int z) { return Voxel{x * x + y * y + z * z < n * n / 16 ? 240.f : 0.05f}; };
    for (const bool nearest : {false, true})
        EXPECT_GT(expect_equal(fill, sun(), nearest, 0.005, nearest ? "a ball of voxels" : "a dense ball"), 300u);
}

} // namespace
} // namespace scree
