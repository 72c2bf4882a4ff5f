// A fill renders to the same bits as the list of its spheres, and behaves like any other scene.

#include "ingest/particles/vdb_point_stream.h"
#include "packing/fill/list_fill.h"
#include "packing/tiles/tile_generator.h"
#include "render/loop/render_setup.h"
#include "tests/builders/scene_files.h"
#include "tests/builders/shapes.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>

namespace scree {
namespace {

using namespace test;

void write_text(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

TriangleMesh placed(TriangleMesh mesh, double scale, const V3d& at)
{
    for (V3d& p : mesh.positions) p = at + scale * p;
    return mesh;
}

/// A ball of radius 2 full of grains of four types, on a floor that it cuts through, under every kind of light.
struct FillScene {
    const TemporaryFolder& folder;
    double scale = 1;
    V3d offset{3.1, -2.7, 10.3};
    double fraction = 0.4;
    double radius = 0.16;
    std::vector<double> radii = std::vector<double>(300, 1);

    V3d at(double x, double y, double z) const { return scale * (offset + V3d(x, y, z)); }
    static std::string text(const V3d& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }
    std::filesystem::path path(const std::string& name) const { return folder.path(name); }

    void write_parts() const
    {
        write_text(path("ball.obj"), obj_text(placed(icosphere(3), 2 * scale, at(0, 0, 0))));
        write_text(path("floor.obj"), obj_text(placed(ground(4, 0), scale, at(0, 0, -1.6))));
        write_text(path("cube.obj"), obj_text(cube()));
        write_text(path("ico.obj"), obj_text(icosphere(1)));
        TileOptions options;
        options.fraction = fraction;
        options.variants = 3;
        write_tile(make_tile(radii, options, {}).tile, path("tile.vdb"));
    }
    /// Lists the fill in batches of some 500 spheres; returns how many there are.
    uint64_t list() const
    {
        const ProceduralFill fill(std::make_shared<const Domain>(read_mesh(path("ball.obj")), "ball.obj"),
                                  std::make_shared<const PackingTile>(read_tile(path("tile.vdb"))),
                                  {radius * scale, 7});
        VdbPointStream stream(path("listed.vdb"), fill.voxel());
        uint64_t count = 0;
        list_fill(fill, 500,
                  [&](const ParticleFrame& batch) {
                      stream.add(batch);
                      count += batch.size();
                  },
                  {});
        stream.finish();
        return count;
    }
    std::string write(const std::string& name, const std::string& assembly) const
    {
        write_text(path(name), fmt::format(R"({{"camera": {{"origin": {}, "target": {}, "up": [0, 0, 1], "fov": 40}},
  "film": {{"size": [48, 36], "aov": ["albedo", "normal", "depth", "type", "id"]}},
  "lights": [{{"kind": "constant", "radiance": 0.4}}, {{"kind": "distant", "direction": [0.5, 0.4, -1], "irradiance": 2}},
             {{"kind": "sphere", "center": {}, "radius": {}, "radiance": 9}}],
  "surfaces": [{{"mesh": "floor.obj", "material": {{"kind": "lambert", "reflectance": 0.5}}}}],
  "grains": {{"types": {{"glass": {{"shape": "sphere", "material": {{"kind": "dielectric", "ior": 1.5, "absorption": {}}}}},
                         "clay": {{"shape": "sphere", "material": {{"kind": "lambert", "reflectance": 0.7}}}},
                         "cube": {{"shape": {{"mesh": "cube.obj"}}, "material": {{"kind": "lambert", "reflectance": [0.8, 0.4, 0.2]}}}},
                         "frost": {{"shape": {{"mesh": "ico.obj"}}, "material": {{"kind": "dielectric", "ior": 1.4, "roughness": 0.3}}}}}},
              "assembly": {},
              "mixture": {{"kind": "random", "types": ["glass", "clay", "cube", "frost"], "weights": [3, 2, 2, 1], "seed": 5}}}}}})",
                                           text(at(1, -7, 2.5)), text(at(0, 0, -0.2)), text(at(-2, -3, 4)), 0.5 * scale,
                                           0.5 / scale, assembly));
        return path(name).string();
    }
    std::string write_fill() const
    {
        return write("fill.json", fmt::format(R"({{"fill": "ball.obj", "tile": "tile.vdb", "radius": {}, "seed": 7}})",
                                              radius * scale));
    }
    std::string write_list() const { return write("list.json", R"({"dump": "listed.vdb"})"); }
};

Picture picture(const std::string& scene, uint32_t spp, int threads = 0)
{
    return render_picture(scene, [&](RenderJob& job) {
        job.spp = spp;
        if (threads > 0) job.threads = threads;
    });
}

TEST(FillScene, IsAnotherWhenAFileOfItsMixtureIs)
{
    const TemporaryFolder folder;
    FillScene scene{folder};
    scene.write_parts();
    const std::string file = scene.write_fill();
    const std::string text = read_bytes(file);
    const auto hash = [&](const std::string& mixture, const std::string& table) {
        write_text(scene.path("m.json"), mixture);
        std::string rows = "type\n";
        for (int i = 0; i < 300; ++i) rows += table + "\n";
        write_text(scene.path("table.csv"), rows);
        const size_t at = text.find("{\"kind\": \"random\"");
        write_text(file, text.substr(0, at) + R"({"file": "m.json"})" + text.substr(text.find('}', at) + 1));
        RenderJob job;
        job.scene = file;
        WorldBuilder builder(load_scene(job));
        return builder.build(0).hash;
    };
    const std::string random = R"({"kind": "random", "types": ["glass", "clay"], "weights": [1, 1], "seed": 5})";
    EXPECT_EQ(hash(random, "clay"), hash(random, "clay"));
    EXPECT_NE(hash(random, "clay"),
              hash(R"({"kind": "random", "types": ["glass", "clay"], "weights": [1, 1], "seed": 6})", "clay"));
    const std::string listed = R"({"kind": "explicit", "table": "table.csv"})";
    EXPECT_EQ(hash(listed, "clay"), hash(listed, "clay"));
    EXPECT_NE(hash(listed, "clay"), hash(listed, "glass"));
}

// Four grain types, two of them meshes, a floor through the fill: some 10^6 segments in all.
TEST(FillPicture, IsThatOfTheListedSpheres)
{
    for (const double fraction : {0.1, 0.3}) {
        const TemporaryFolder folder;
        FillScene scene{folder};
        scene.fraction = fraction;
        scene.write_parts();
        const uint64_t count = scene.list();
        EXPECT_GT(count, fraction * 1200) << "of " << fraction * 8 / (0.16 * 0.16 * 0.16);
        EXPECT_EQ(difference(picture(scene.write_fill(), 24), picture(scene.write_list(), 24)), "")
            << "fraction " << fraction;
    }
}

TEST(FillPicture, OfManySizesIsThatOfTheListedSpheres)
{
    const TemporaryFolder folder;
    FillScene scene{folder};
    for (size_t i = 0; i < scene.radii.size(); ++i) scene.radii[i] = 0.4 + 0.6 * std::pow(double(i) / 300, 4);
    scene.write_parts();
    scene.list();
    EXPECT_EQ(difference(picture(scene.write_fill(), 24), picture(scene.write_list(), 24)), "");
}

TEST(FillPicture, IsTheSameOnAnyNumberOfThreads)
{
    const TemporaryFolder folder;
    const FillScene scene{folder};
    scene.write_parts();
    const std::string file = scene.write_fill();
    const Picture one = picture(file, 4, 1);
    EXPECT_EQ(difference(picture(file, 4, 2), one), "");
    EXPECT_EQ(difference(picture(file, 4, 5), one), "");
}

TEST(FillPicture, IsTheSameAtAnyScaleOfTwo)
{
    const TemporaryFolder folder;
    FillScene scene{folder};
    scene.write_parts();
    const Picture one = picture(scene.write_fill(), 4);
    for (const int exponent : {-20, 20, 60}) {
        scene.scale = std::ldexp(1, exponent);
        scene.write_parts();
        EXPECT_EQ(difference(picture(scene.write_fill(), 4), one, static_cast<float>(scene.scale)), "")
            << "2^" << exponent;
    }
}

TEST(FillPicture, OfLosslessGrainsIsWhiteInAWhiteSky)
{
    const TemporaryFolder folder;
    const FillScene scene{folder};
    scene.write_parts();
    write_text(scene.path("white.json"),
               fmt::format(R"({{"camera": {{"origin": {}, "target": {}, "up": [0, 0, 1], "fov": 40}},
  "film": {{"size": [24, 18]}}, "lights": [{{"kind": "constant", "radiance": 1}}],
  "grains": {{"types": {{"glass": {{"shape": "sphere", "material": {{"kind": "dielectric", "ior": 1.5}}}},
                         "white": {{"shape": {{"mesh": "cube.obj"}}, "material": {{"kind": "lambert", "reflectance": 1}}}}}},
              "assembly": {{"fill": "ball.obj", "tile": "tile.vdb", "radius": 0.16}},
              "mixture": {{"kind": "random", "types": ["glass", "white"]}}}}}})",
                           FillScene::text(scene.at(1, -7, 2.5)), FillScene::text(scene.at(0, 0, 0))));
    const Picture white = picture(scene.path("white.json").string(), 8);
    for (const char* channel : {"R", "G", "B"}) {
        for (const float value : white.floats.at(channel)) ASSERT_NEAR(value, 1, 1e-5);
    }
}

} // namespace
} // namespace scree
