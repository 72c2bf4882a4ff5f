// `scree grains` as a user sees it: the built program, its exit codes, messages and files.

#include "ingest/meshes/triangle_mesh.h"
#include "render/grains/library/grain_library.h"
#include "tests/builders/scene_files.h"
#include "tests/builders/scree_process.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <set>

namespace scree {
namespace {

using namespace test;
using testing::HasSubstr;

class GrainsCommand : public testing::Test {
protected:
    std::string path(const std::string& name) const { return folder_.path(name).string(); }
    bool nothing_written() const { return std::filesystem::is_empty(folder_.path()); }

    TemporaryFolder folder_;
};

TEST_F(GrainsCommand, ListsEveryType)
{
    const ProgramRun run = run_scree({"grains", "list"});
    EXPECT_EQ(run.status, 0);
    for (const LibraryGrain& grain : grain_library()) {
        EXPECT_THAT(run.out, HasSubstr("\n" + grain.name + " "));
        EXPECT_THAT(run.out, HasSubstr(grain.description));
    }
}

TEST_F(GrainsCommand, ListsAsJson)
{
    const ProgramRun run = run_scree({"grains", "list", "--json"});
    EXPECT_EQ(run.status, 0);
    const auto list = nlohmann::json::parse(run.out);
    ASSERT_EQ(list.size(), grain_library().size());
    for (size_t i = 0; i < list.size(); ++i) {
        const LibraryGrain& grain = grain_library()[i];
        EXPECT_EQ(list[i].at("name"), grain.name);
        EXPECT_EQ(list[i].at("typical_radius"), grain.typical_radius);
        EXPECT_EQ(list[i].at("triangles"), grain.default_triangles);
        EXPECT_EQ(list[i].at("parameters").size(), shape_parameters(grain).size());
        EXPECT_EQ(list[i].at("material").at("kind"), grain.material.transmits() ? "dielectric" : "lambert");
    }
    const auto sugar = nlohmann::json::parse(run_scree({"grains", "list", "sugar", "--json"}).out);
    ASSERT_EQ(sugar.size(), 1u);
    EXPECT_EQ(sugar[0].at("name"), "sugar");
}

TEST_F(GrainsCommand, ListsParametersOfOneType)
{
    const ProgramRun run = run_scree({"grains", "list", "cinnamon"});
    EXPECT_EQ(run.status, 0);
    for (const ShapeParameter& parameter : shape_parameters(*find_library_grain("cinnamon"))) {
        EXPECT_THAT(run.out, HasSubstr(parameter.name));
        EXPECT_THAT(run.out, HasSubstr(parameter.what));
    }
    EXPECT_THAT(run_scree({"grains", "list", "dielectric_sphere"}).out, HasSubstr("no parameters"));
}

TEST_F(GrainsCommand, ExportsTheSameMeshToEveryFormat)
{
    const ShapeOptions options{3, 600, {{"chips", 2}}};
    const TriangleMesh mesh = make_grain_shape(*find_library_grain("sugar"), options, "test");
    for (const std::string extension : {"obj", "ply", "stl", "off", "PLY"}) {
        const std::string file = path("sugar." + extension);
        const ProgramRun run = run_scree(
            {"grains", "export", "sugar", "-o", file, "--triangles", "600", "--seed", "3", "--set", "chips=2"});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_THAT(run.out, HasSubstr("600 triangles"));
        const TriangleMesh read = read_mesh(file);
        ASSERT_EQ(read.triangles.size(), mesh.triangles.size()) << extension;
        EXPECT_TRUE(is_closed_and_oriented(read)) << extension;
        if (extension == "stl") { // has floats and no shared vertices, so vertices are merged in another order
            EXPECT_NEAR(signed_volume(read), signed_volume(mesh), 1e-6);
        } else {
            EXPECT_EQ(read.triangles, mesh.triangles) << extension;
            EXPECT_EQ(read.positions, mesh.positions) << extension;
        }
    }
}

TEST_F(GrainsCommand, ShowsASheet)
{
    const ProgramRun run =
        run_scree({"grains", "show", "sugar", "hairball", "dielectric_sphere", "diffuse_sphere", "-o",
                   path("sheet.png"), "--size", "24", "--spp", "1", "--triangles", "300", "--seed", "2"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_GT(std::filesystem::file_size(path("sheet.png")), 500u);
    EXPECT_EQ(run_scree({"grains", "show", "flour", "-o", path("one.jpg"), "--size", "24", "--spp", "1", "-q"}).err,
              "");
    EXPECT_TRUE(std::filesystem::exists(path("one.jpg")));
}

struct Wrong {
    std::vector<std::string> arguments; ///< PATH is replaced by the folder
    std::string message;
};

TEST_F(GrainsCommand, WrongUseIsExplained)
{
    const std::vector<Wrong> wrong{
        {{"grains"}, "subcommand is required"},
        {{"grains", "list", "suger"}, "did you mean 'sugar'?"},
        {{"grains", "export", "suger", "-o", "PATH/a.obj"}, "did you mean 'sugar'?"},
        {{"grains", "export", "sugar"}, "--output is required"},
        {{"grains", "export", "sugar", "-o", "PATH/a.fbx"}, ".obj, .ply, .stl or .off"},
        {{"grains", "export", "sugar", "-o", "PATH/a"}, "no extension"},
        {{"grains", "export", "sugar", "-o", "PATH/no/a.obj"}, "no folder"},
        {{"grains", "export", "sugar", "-o", "PATH/a.obj", "--triangles", "19"}, "--triangles"},
        {{"grains", "export", "sugar", "-o", "PATH/a.obj", "--set", "chips"}, "name=value"},
        {{"grains", "export", "sugar", "-o", "PATH/a.obj", "--set", "chips=many"}, "name=value"},
        {{"grains", "export", "sugar", "-o", "PATH/a.obj", "--set", "chip=3"}, "did you mean 'chips'?"},
        {{"grains", "export", "sugar", "-o", "PATH/a.obj", "--set", "chips=1000"}, "0 to 30"},
        {{"grains", "export", "diffuse_sphere", "-o", "PATH/a.obj", "--set", "chips=1"}, "no parameters"},
        {{"grains", "show", "suger", "-o", "PATH/a.png"}, "did you mean 'sugar'?"},
        {{"grains", "show", "-o", "PATH/a.doc"}, "a picture format"},
        {{"grains", "show", "-o", "PATH/no/a.png"}, "no folder"},
        {{"grains", "show", "-o", "PATH/a.png", "--size", "0"}, "--size"}};
    for (Wrong w : wrong) {
        for (std::string& argument : w.arguments) {
            if (argument.starts_with("PATH/")) argument = path(argument.substr(5));
        }
        const ProgramRun run = run_scree(w.arguments);
        SCOPED_TRACE(testing::PrintToString(w.arguments));
        EXPECT_EQ(run.status, 2);
        EXPECT_THAT(run.err, HasSubstr(w.message));
        EXPECT_TRUE(nothing_written());
    }
}

// The scene file's library shapes, through to the plan and the picture.
TEST_F(GrainsCommand, ScenesRenderLibraryGrains)
{
    const std::string scene = folder_.write(
        "scene.json",
        R"({"camera": {"origin": [0, -8, 3], "target": [0, 0, 0]}, "film": {"size": [24, 16], "aov": ["type"]},
        "lights": [{"kind": "constant"}],
        "grains": {"unit": "cm", "types": {"sweet": {"shape": {"library": "brown_sugar", "triangles": 500, "seed": 4}}, "ball": {"shape": "diffuse_sphere"},
                             "flake": {"shape": "snowflake", "material": {"kind": "lambert", "reflectance": 0.5}}},
          "assembly": {"spheres": [{"center": [-2, 0, 0], "radius": 1, "type": "sweet"}, {"center": [0, 0, 0], "radius": 1, "type": "ball"},
                                   {"center": [2, 0, 0], "radius": 1, "type": "flake"}]}}})");
    const ProgramRun plan = run_scree({"render", scene, "--plan"});
    EXPECT_EQ(plan.status, 0) << plan.err;
    EXPECT_THAT(plan.out, HasSubstr("500 triangles of the library's brown_sugar"));
    EXPECT_THAT(plan.out, HasSubstr("the bounding sphere itself"));
    EXPECT_THAT(plan.out, HasSubstr("of the library's snowflake"));
    const auto hash_of = [&](const std::string& shape) {
        const ProgramRun run = run_scree(
            {"render", scene, "-o", path("out.exr"), "--spp", "4", "-q", "-D", "grains.types.sweet.shape=" + shape});
        EXPECT_EQ(run.status, 0) << run.err;
        const test::Picture picture = read_picture(path("out.exr"));
        EXPECT_TRUE(picture.all_finite());
        std::set<uint32_t> types(picture.integers.at("type").begin(), picture.integers.at("type").end());
        EXPECT_EQ(types.size(), 4u) << "three types and none";
        return picture.texts.at("sceneHash");
    };
    EXPECT_EQ(hash_of(R"("sugar")"), hash_of(R"("sugar")"));
    EXPECT_NE(hash_of(R"({"library": "sugar", "triangles": 400})"),
              hash_of(R"({"library": "sugar", "triangles": 400, "seed": 1})"));
}

} // namespace
} // namespace scree
