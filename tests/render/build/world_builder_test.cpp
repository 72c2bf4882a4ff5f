// Building a scene: render coordinates keep their precision; bad input is refused, and inward meshes are turned.

#include "render/build/world_builder.h"

#include "base/error.h"
#include "base/json.h"
#include "render/film/exr_output.h"
#include "tests/builders/scene_files.h"
#include "tests/builders/shapes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>

namespace scree {
namespace {

using test::TemporaryFolder;

std::shared_ptr<const World> build(const std::string& json, const std::filesystem::path& folder)
{
    const JsonDocument document = JsonDocument::parse(json, "scene.json", folder);
    WorldBuilder builder(read_scene(document, folder / "scene.json"));
    return builder.build(0).world;
}

std::string scene_with(const std::string& rest)
{
    return R"({"camera": {"origin": [0, -5, 0], "target": [0, 0, 0]}, )" + rest + "}";
}

// 100 grains of radius 0.3 in a 10 x 10 lattice, and one more grain far away. The distance of neighbours in radii must
// be right wherever the one grain is. With the bounds' middle as origin, a float would keep the distance to 0.1 (at
// 3e6) or not at all (at 3e8).
TEST(WorldBuilder, RunawayGrainLeavesTheOthersTheirPrecision)
{
    for (const double away : {3.0, 3e6, 3e8}) {
        std::string spheres;
        for (int i = 0; i < 100; ++i)
            spheres += fmt::format(R"({{"center": [{}, {}, 0.1], "radius": 0.3}}, )", 0.7 * (i % 10), 0.7 * (i / 10));
        spheres += fmt::format(R"({{"center": [{}, 0, 0], "radius": 0.3}})", away);
        const auto world =
            build(scene_with(R"("grains": {"types": {"g": {"shape": "sphere", "material": {"kind": "lambert"}}},
            "assembly": {"spheres": [)" +
                             spheres + "]}}"),
                  ".");
        ASSERT_EQ(world->grains.size(), 101u);
        for (uint32_t i = 1; i < 100; ++i) {
            if (i % 10 == 0) continue;
            const double gap =
                (world->grains.centre(i) - world->grains.centre(i - 1)).length() / world->grains.radius(i);
            ASSERT_NEAR(gap, 0.7 / 0.3, 1e-4) << "one grain at " << away;
        }
    }
}

TEST(WorldBuilder, GlassSurfaceIsTurnedOutwards)
{
    const TemporaryFolder folder;
    TriangleMesh inward = cube();
    for (auto& triangle : inward.triangles) std::swap(triangle[1], triangle[2]);
    std::ofstream(folder.path() / "out.obj") << test::obj_text(cube());
    std::ofstream(folder.path() / "in.obj") << test::obj_text(inward);
    const auto world = build(scene_with(R"("surfaces": [{"mesh": "out.obj", "material": {"kind": "dielectric"}},
        {"mesh": "in.obj", "material": {"kind": "dielectric"}}])"),
                             folder.path());
    for (const Surface& surface : world->surfaces) {
        for (const auto& t : surface.triangles) {
            const V3d a(surface.positions[t[0]]), b(surface.positions[t[1]]), c(surface.positions[t[2]]);
            EXPECT_GT((b - a).cross(c - a).dot(a + b + c), 0) << surface.name; // away from the cube's middle
        }
    }
}

TEST(WorldBuilder, OpenGlassSurfaceIsRefused)
{
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "open.obj") << test::obj_text(ground(1, 0));
    const auto scene = [](const char* kind) {
        return scene_with(fmt::format(R"("surfaces": [{{"mesh": "open.obj", "material": {{"kind": "{}"}}}}])", kind));
    };
    EXPECT_NO_THROW(build(scene("lambert"), folder.path()));
    try {
        build(scene("dielectric"), folder.path());
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_THAT(error.place(), testing::HasSubstr("open.obj"));
        EXPECT_THAT(error.expected(), testing::HasSubstr("closed"));
    }
}

TEST(WorldBuilder, CroppedEnvironmentMapIsRefused)
{
    const TemporaryFolder folder;
    write_exr(folder.path() / "whole.exr", Film(16, 8, 0, 0, 16, 8), {}, {});
    write_exr(folder.path() / "crop.exr", Film(16, 8, 0, 4, 16, 8), {}, {});
    const auto scene = [](const char* file) {
        return scene_with(fmt::format(R"("lights": [{{"kind": "environment", "file": "{}"}}])", file));
    };
    EXPECT_NO_THROW(build(scene("whole.exr"), folder.path()));
    try {
        build(scene("crop.exr"), folder.path());
        FAIL() << "no error";
    } catch (const InputError& error) {
        EXPECT_THAT(error.found(), testing::HasSubstr("crop of 16x4"));
    }
}

} // namespace
} // namespace scree
