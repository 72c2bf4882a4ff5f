// The scene file: every key with its default and unit, and what is said when something is wrong.

#include "ingest/support/json.h"
#include "render/scene/scene_description.h"
#include "tests/ingest/test_files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace scree {
namespace {

using test::input_error_of;
using testing::HasSubstr;

SceneDescription read(const std::string& text)
{
    return read_scene(JsonDocument::parse(text, "scene.json", "/scenes/here"), "/scenes/here/scene.json");
}

const std::string camera = R"("camera": {"origin": [0, -10, 2], "target": [0, 0, 1]})";
SceneDescription read_with(const std::string& keys) { return read("{" + camera + ", " + keys + "}"); }

TEST(SceneDescription, HasDefaults)
{
    const SceneDescription scene = read("{" + camera + "}");
    EXPECT_EQ(scene.file, "/scenes/here/scene.json");
    EXPECT_EQ(scene.camera.kind, CameraKind::perspective);
    EXPECT_EQ(scene.camera.origin, V3d(0, -10, 2));
    EXPECT_EQ(scene.camera.target, V3d(0, 0, 1));
    EXPECT_EQ(scene.camera.up, V3d(0, 0, 1));
    EXPECT_EQ(scene.camera.fov, 35);
    EXPECT_EQ(scene.camera.aperture, 0);
    EXPECT_EQ(scene.camera.focus, 0);
    EXPECT_EQ(scene.film.width, 640);
    EXPECT_EQ(scene.film.height, 480);
    EXPECT_EQ(scene.film.filter.kind, FilterKind::gaussian);
    EXPECT_EQ(scene.film.filter.radius, 1.5);
    EXPECT_TRUE(scene.film.aov.empty());
    EXPECT_TRUE(scene.lights.empty());
    EXPECT_TRUE(scene.surfaces.empty());
    EXPECT_TRUE(scene.types.empty());
    EXPECT_FALSE(scene.assembly);
    EXPECT_EQ(scene.integrator.kind, IntegratorKind::automatic);
    EXPECT_EQ(scene.integrator.max_depth, 0u);
    EXPECT_EQ(scene.integrator.accuracy, Accuracy::standard);
}

TEST(SceneDescription, ReadsCameras)
{
    const CameraDescription p = read(R"({"$schema": "scene.schema.json", "camera": {"kind": "perspective", "origin": [1, 2, 3], "target": [4, 5, 6],
        "up": [0, 1, 0], "fov": 60.5, "aperture": 0.25, "focus": 12}})").camera;
    EXPECT_EQ(p.origin, V3d(1, 2, 3));
    EXPECT_EQ(p.target, V3d(4, 5, 6));
    EXPECT_EQ(p.up, V3d(0, 1, 0));
    EXPECT_EQ(p.fov, 60.5);
    EXPECT_EQ(p.aperture, 0.25);
    EXPECT_EQ(p.focus, 12);
    const CameraDescription o = read(R"({"camera": {"kind": "orthographic", "origin": [1e7, 2, 3], "target": [4, 5, 6], "width": 20, "aperture": 1, "focus": 2}})").camera;
    EXPECT_EQ(o.kind, CameraKind::orthographic);
    EXPECT_EQ(o.width, 20);
    EXPECT_EQ(o.origin.x, 1e7);
    EXPECT_EQ(o.focus, 2);
}

TEST(SceneDescription, ReadsFilms)
{
    const FilmDescription film = read_with(R"("film": {"size": [64, 48.0], "filter": "box", "aov": ["albedo", "normal", "depth", "type", "id", "variance", "samples", "depth"]})").film;
    EXPECT_EQ(film.width, 64);
    EXPECT_EQ(film.height, 48);
    EXPECT_EQ(film.filter.kind, FilterKind::box);
    EXPECT_EQ(film.filter.radius, 0.5);
    EXPECT_EQ(film.aov, (std::vector<Aov>{Aov::albedo, Aov::normal, Aov::depth, Aov::type, Aov::id, Aov::variance, Aov::samples}));
    const Filter tent = read_with(R"("film": {"filter": "tent"})").film.filter;
    EXPECT_EQ(tent.kind, FilterKind::tent);
    EXPECT_EQ(tent.radius, 1);
    const Filter wide = read_with(R"("film": {"filter": {"kind": "gaussian", "radius": 2.5}})").film.filter;
    EXPECT_EQ(wide.kind, FilterKind::gaussian);
    EXPECT_EQ(wide.radius, 2.5);
    EXPECT_EQ(read_with(R"("film": {"filter": {"kind": "tent"}})").film.filter.radius, 1);
}

TEST(SceneDescription, ReadsLights)
{
    const auto lights = read_with(R"("lights": [{"kind": "constant"}, {"kind": "constant", "radiance": [1, 2, 3]},
        {"kind": "environment", "file": "sky.exr"}, {"kind": "environment", "file": "/abs/sky.exr", "scale": 2, "up": [0, 1, 0]},
        {"kind": "distant", "direction": [1, 2, -3]}, {"kind": "distant", "direction": [0, 0, -1], "irradiance": [3, 2, 1], "angle": 0},
        {"kind": "rectangle", "corner": [1, 2, 3], "edges": [[1, 0, 0], [0, 2, 0]], "radiance": 10},
        {"kind": "sphere", "center": [3, 2, 1], "radius": 0.5}])").lights;
    ASSERT_EQ(lights.size(), 8u);
    EXPECT_EQ(lights[0].radiance, C3f(1));
    EXPECT_EQ(lights[1].radiance, C3f(1, 2, 3));
    EXPECT_EQ(lights[2].file, "/scenes/here/sky.exr");
    EXPECT_EQ(lights[2].scale, C3f(1));
    EXPECT_EQ(lights[2].up, V3d(0, 0, 1));
    EXPECT_EQ(lights[3].file, "/abs/sky.exr");
    EXPECT_EQ(lights[3].scale, C3f(2));
    EXPECT_EQ(lights[3].up, V3d(0, 1, 0));
    EXPECT_EQ(lights[4].direction, V3d(1, 2, -3));
    EXPECT_EQ(lights[4].irradiance, C3f(1));
    EXPECT_EQ(lights[4].angle, 0.53);
    EXPECT_EQ(lights[5].irradiance, C3f(3, 2, 1));
    EXPECT_EQ(lights[5].angle, 0);
    EXPECT_EQ(lights[6].corner, V3d(1, 2, 3));
    EXPECT_EQ(lights[6].edge1, V3d(1, 0, 0));
    EXPECT_EQ(lights[6].edge2, V3d(0, 2, 0));
    EXPECT_EQ(lights[6].radiance, C3f(10));
    EXPECT_EQ(lights[7].center, V3d(3, 2, 1));
    EXPECT_EQ(lights[7].radius, 0.5);
    EXPECT_EQ(lights[7].radiance, C3f(1));
    EXPECT_EQ(lights[7].place, "scene.json: /lights/7");
}

TEST(SceneDescription, ReadsSurfacesAndMaterials)
{
    const auto surfaces = read_with(R"("surfaces": [
        {"mesh": "a.obj", "material": {"kind": "lambert"}}, {"mesh": "../b.ply", "material": {"kind": "lambert", "reflectance": [0.1, 0.2, 1]}},
        {"mesh": "c.obj", "material": {"kind": "dielectric"}},
        {"mesh": "d.obj", "material": {"kind": "dielectric", "ior": 1.31, "roughness": 0.5, "absorption": [1, 2, 3], "tint": 0.98}},
        {"mesh": "e.obj", "material": {"kind": "conductor", "eta": [0.2, 0.9, 1.1], "k": 3.9}},
        {"mesh": "f.obj", "material": {"kind": "conductor", "eta": 0, "k": 0, "roughness": 1, "tint": [1, 0.5, 0]}},
        {"mesh": "g.obj", "material": {"kind": "dielectric", "ior": 1, "roughness": 0.5}}])").surfaces;
    ASSERT_EQ(surfaces.size(), 7u);
    EXPECT_EQ(surfaces[0].mesh, "/scenes/here/a.obj");
    EXPECT_EQ(surfaces[0].material.kind, MaterialKind::lambert);
    EXPECT_EQ(surfaces[0].material.reflectance, C3f(0.5f));
    EXPECT_EQ(surfaces[1].mesh, "/scenes/here/../b.ply");
    EXPECT_EQ(surfaces[1].material.reflectance, C3f(0.1f, 0.2f, 1));
    const Material& glass = surfaces[2].material;
    EXPECT_EQ(glass.kind, MaterialKind::dielectric);
    EXPECT_EQ(glass.ior, 1.5);
    EXPECT_EQ(glass.alpha, 0);
    EXPECT_EQ(glass.absorption, C3f(0.0f));
    EXPECT_EQ(glass.tint, C3f(1));
    EXPECT_EQ(surfaces[3].material.ior, 1.31);
    EXPECT_EQ(surfaces[3].material.alpha, 0.25) << "the GGX width is the square of the roughness";
    EXPECT_EQ(surfaces[3].material.absorption, C3f(1, 2, 3)) << "per unit of length of the scene";
    EXPECT_EQ(surfaces[3].material.tint, C3f(0.98f));
    EXPECT_EQ(surfaces[4].material.kind, MaterialKind::conductor);
    EXPECT_EQ(surfaces[4].material.eta, C3f(0.2f, 0.9f, 1.1f));
    EXPECT_EQ(surfaces[4].material.k, C3f(3.9f));
    EXPECT_EQ(surfaces[5].material.alpha, 1);
    EXPECT_EQ(surfaces[5].material.tint, C3f(1, 0.5f, 0));
    EXPECT_EQ(surfaces[6].material.alpha, 0) << "without a step in the index there is nothing to be rough";
}

const std::string clay = R"("clay": {"shape": "sphere", "material": {"kind": "lambert"}})";
const std::string stone = R"("stone": {"shape": {"mesh": "stone.ply"}, "material": {"kind": "lambert"}})";

TEST(SceneDescription, ReadsGrainsFromADump)
{
    const SceneDescription scene = read_with(R"("grains": {"types": {)" + stone + ", " + clay +
        R"(}, "assembly": {"dump": "run/pour.*.dump.gz", "types": {"1": "stone", "2": "clay", "-7": "clay"}, "radius": {"1": 0.5, "2": 1}}, "mixture": {"kind": "explicit"}})");
    ASSERT_EQ(scene.types.size(), 2u);
    EXPECT_EQ(scene.types[0].name, "clay") << "in order of name";
    EXPECT_FALSE(scene.types[0].mesh);
    EXPECT_EQ(scene.types[1].mesh, "/scenes/here/stone.ply");
    ASSERT_TRUE(scene.assembly);
    EXPECT_EQ(scene.assembly->dump, "/scenes/here/run/pour.*.dump.gz");
    EXPECT_EQ(scene.assembly->types, (std::map<int32_t, std::string>{{1, "stone"}, {2, "clay"}, {-7, "clay"}}));
    EXPECT_EQ(scene.assembly->radius_of_type, (std::map<int32_t, double>{{1, 0.5}, {2, 1}}));
    EXPECT_FALSE(scene.assembly->radius);
    // One type needs no map.
    const auto one = read_with(R"("grains": {"types": {)" + clay + R"(}, "assembly": {"dump": "a.dump", "radius": 0.25}})").assembly;
    EXPECT_TRUE(one->types.empty());
    EXPECT_EQ(one->radius, 0.25);
}

TEST(SceneDescription, ReadsGrainsWrittenOut)
{
    const auto one = read_with(R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": [{"center": [1, 2, 3], "radius": 0.5}, {"center": [0, 0, 0], "radius": 0}]}})").assembly;
    ASSERT_EQ(one->spheres.size(), 2u);
    EXPECT_EQ(one->spheres[0].center, V3d(1, 2, 3));
    EXPECT_EQ(one->spheres[0].radius, 0.5);
    EXPECT_EQ(one->spheres[0].type, "");
    const auto two = read_with(R"("grains": {"types": {)" + clay + ", " + stone + R"(}, "assembly": {"spheres": [{"center": [1, 2, 3], "radius": 0.5, "type": "stone"}]}})").assembly;
    EXPECT_EQ(two->spheres[0].type, "stone");
    EXPECT_TRUE(read_with(R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": []}})").assembly->spheres.empty());
}

GrainTypeDescription read_type(const std::string& type, const std::string& before = "")
{
    return read_with(R"("grains": {)" + before + R"("types": {"a": )" + type + R"(}, "assembly": {"spheres": []}})").types[0];
}

TEST(SceneDescription, LibraryShapesBringTheirMaterial)
{
    const LibraryGrain& sugar = *find_library_grain("brown_sugar");
    const GrainTypeDescription type = read_type(R"({"shape": "brown_sugar"})");
    EXPECT_EQ(type.library, &sugar);
    EXPECT_FALSE(type.mesh);
    EXPECT_TRUE(type.has_mesh());
    EXPECT_EQ(type.shape.triangles, 0u);
    EXPECT_EQ(type.shape.seed, 0u);
    EXPECT_EQ(type.material.kind, MaterialKind::dielectric);
    EXPECT_EQ(type.material.ior, sugar.material.ior);
    EXPECT_EQ(type.material.alpha, sugar.material.alpha);
    const GrainTypeDescription fine = read_type(R"({"shape": {"library": "brown_sugar", "triangles": 5000, "seed": 7, "parameters": {"chips": 2}}})");
    EXPECT_EQ(fine.library, &sugar);
    EXPECT_EQ(fine.shape.triangles, 5000u);
    EXPECT_EQ(fine.shape.seed, 7u);
    EXPECT_EQ(fine.shape.parameters, (std::map<std::string, double>{{"chips", 2}}));
    // A material beside it replaces it.
    const GrainTypeDescription clay_sugar = read_type(R"({"shape": "brown_sugar", "material": {"kind": "lambert", "reflectance": 0.25}})");
    EXPECT_EQ(clay_sugar.library, &sugar);
    EXPECT_EQ(clay_sugar.material.kind, MaterialKind::lambert);
    EXPECT_EQ(clay_sugar.material.reflectance, C3f(0.25f));
    // Spheres are meshes only when triangles are asked for.
    EXPECT_FALSE(read_type(R"({"shape": "diffuse_sphere"})").has_mesh());
    EXPECT_TRUE(read_type(R"({"shape": {"library": "diffuse_sphere", "triangles": 80}})").has_mesh());
}

TEST(SceneDescription, UnitsConvertTheLibrarysAbsorptionOnly)
{
    const C3f per_metre = find_library_grain("brown_sugar")->material.absorption;
    ASSERT_GT(per_metre.x, 0);
    for (const auto& [unit, metres] : std::vector<std::pair<std::string, float>>{
             {"", 1e-3f}, {R"("unit": "mm", )", 1e-3f}, {R"("unit": "m", )", 1}, {R"("unit": "cm", )", 1e-2f}, {R"("unit": "um", )", 1e-6f}, {R"("unit": 0.5, )", 0.5f}}) {
        const C3f found = read_type(R"({"shape": "brown_sugar"})", unit).material.absorption;
        for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(found[i], metres * per_metre[i]) << unit;
        EXPECT_EQ(read_type(R"({"shape": "brown_sugar", "material": {"kind": "dielectric", "absorption": [1, 2, 3]}})", unit).material.absorption, C3f(1, 2, 3));
    }
}

TEST(SceneDescription, ReadsIntegrators)
{
    const SceneDescription scene = read_with(R"("medium": [], "integrator": {"kind": "ept", "accuracy": "reference", "max_depth": 7})");
    EXPECT_EQ(scene.integrator.kind, IntegratorKind::ept);
    EXPECT_EQ(scene.integrator.accuracy, Accuracy::reference);
    EXPECT_EQ(scene.integrator.max_depth, 7u);
    EXPECT_EQ(read_with(R"("integrator": {})").integrator.kind, IntegratorKind::automatic);
    EXPECT_EQ(read_with(R"("integrator": {"kind": "ppt", "explicit_grains": 2})").integrator.explicit_grains, 2u);
    const IntegratorDescription switches = read_with(R"("integrator": {"grain_pixels": 0.5, "grain_flights": 2, "least_shell": 4})").integrator;
    EXPECT_EQ(switches.grain_pixels, 0.5);
    EXPECT_EQ(switches.grain_flights, 2);
    EXPECT_EQ(switches.least_shell, 4);
    EXPECT_FALSE(IntegratorDescription().grain_pixels || IntegratorDescription().grain_flights || IntegratorDescription().least_shell);
    EXPECT_FALSE(scene.integrator.shells) << "as the integrator has it";
    EXPECT_EQ(scene.integrator.stf_form, StfForm::full);
    const IntegratorDescription stf = read_with(R"("integrator": {"kind": "stf", "shells": false, "stf_form": "diffusion"})").integrator;
    EXPECT_EQ(stf.kind, IntegratorKind::stf);
    EXPECT_EQ(stf.shells, std::optional(false));
    EXPECT_EQ(stf.stf_form, StfForm::diffusion);
    EXPECT_EQ(read_with(R"("integrator": {"shells": true})").integrator.shells, std::optional(true));
    for (const auto& [name, form] : {std::pair{"full", StfForm::full}, {"cosine", StfForm::cosine}, {"hg", StfForm::hg}, {"interpolated", StfForm::interpolated}}) {
        EXPECT_EQ(read_with(fmt::format(R"("integrator": {{"stf_form": "{}"}})", name)).integrator.stf_form, form);
    }
}

TEST(SceneDescription, ReadsMedia)
{
    const SceneDescription scene = read_with(R"("medium": [{"mesh": "slab.off", "sigma_t": [1, 2, 3], "albedo": 0.9, "g": -0.5},
        {"vdb": "cloud.vdb", "density": "rho", "scale": 10, "albedo": "colour", "g": 0.85, "interpolation": "nearest"}], "integrator": {"kind": "vpt", "grain_depth": 4, "medium_form": "walk"})");
    ASSERT_EQ(scene.media.size(), 2u);
    EXPECT_EQ(scene.media[0].mesh.filename(), "slab.off");
    EXPECT_EQ(scene.media[0].sigma_t, C3f(1, 2, 3));
    EXPECT_EQ(scene.media[0].albedo, C3f(0.9f));
    EXPECT_EQ(scene.media[0].g, -0.5);
    EXPECT_EQ(scene.media[1].vdb.filename(), "cloud.vdb");
    EXPECT_EQ(scene.media[1].density, "rho");
    EXPECT_EQ(scene.media[1].sigma_t, C3f(10));
    EXPECT_EQ(scene.media[1].albedo_grid, "colour");
    EXPECT_EQ(scene.media[1].g, 0.85);
    EXPECT_TRUE(scene.media[1].nearest);
    EXPECT_EQ(scene.integrator.kind, IntegratorKind::vpt);
    EXPECT_EQ(scene.integrator.grain_depth, 4);
    EXPECT_EQ(scene.integrator.medium_form, EquivalentForm::walk);
}

TEST(SceneDescription, TakesNullForAbsent)
{
    EXPECT_EQ(read_with(R"("film": null, "integrator": {"max_depth": null}, "medium": null)").film.width, 640);
}

TEST(SceneDescription, CanonicalTextIgnoresLayoutAndComments)
{
    const std::string text = "{" + camera + R"(, "film": {"size": [4, 3]}})";
    EXPECT_EQ(read("// A comment\n" + text).canonical, read(R"({"film": /* here */ {"size":[4,3]}, )" + camera + "}").canonical);
    EXPECT_NE(read(text).canonical, read("{" + camera + R"(, "film": {"size": [3, 4]}})").canonical);
}

// --- wrong scenes ---

struct Wrong {
    std::string keys;     ///< after the camera; or a whole scene when it starts with {
    std::string path, found, expected, hint;
};

const std::string grains_of_two = R"("grains": {"types": {)" + clay + ", " + stone + "}, ";

const std::vector<Wrong> wrong_scenes{
    {"{}", "/", "no key 'camera'", "the key 'camera'", ""},
    {"[1]", "/", "[1]", "an object", ""},
    {R"({"camra": {"origin": [0, 0, 0]}})", "/", "the key 'camra' and no 'camera'", "the key 'camera'", ""},
    {R"("lihgts": [])", "/", "the unknown key 'lihgts'", "lights", "did you mean 'lights'?"},
    {R"("film": {"size": [640]})", "/film/size", "[640]", "a list of 2", ""},
    {R"("film": {"size": [640, 0]})", "/film/size/1", "0", "1..65536", ""},
    {R"("film": {"size": [640, 480.5]})", "/film/size/1", "480.5", "a whole number", ""},
    {R"("film": {"size": [1e30, 1]})", "/film/size/0", "1e+30", "65536", ""},
    {R"("film": {"size": "big"})", "/film/size", "\"big\"", "a list of 2", ""},
    {R"("film": {"width": 3})", "/film", "'width'", "one of aov, filter, size", ""},
    {R"("film": {"filter": "gausian"})", "/film/filter", "\"gausian\"", "box, tent, gaussian", "did you mean 'gaussian'?"},
    {R"("film": {"filter": {"kind": "box", "radius": 0}})", "/film/filter/radius", "0", "a number above 0", ""},
    {R"("film": {"filter": {"radius": 1}})", "/film/filter", "no key 'kind'", "the key 'kind'", ""},
    {R"("film": {"filter": 3})", "/film/filter", "3", "an object", ""},
    {R"("film": {"aov": ["norml"]})", "/film/aov/0", "\"norml\"", "albedo, normal", "did you mean 'normal'?"},
    {R"("film": {"aov": "normal"})", "/film/aov", "\"normal\"", "a list", ""},
    {R"({"camera": {"target": [0, 0, 1]}})", "/camera", "no key 'origin'", "the key 'origin'", ""},
    {R"({"camera": {"origin": [0, 0], "target": [0, 0, 1]}})", "/camera/origin", "[0,0]", "a list of 3", ""},
    {R"({"camera": {"origin": [0, "a", 0], "target": [0, 0, 1]}})", "/camera/origin/1", "\"a\"", "a number", ""},
    {R"({"camera": {"origin": [0, 0, 1], "target": [0, 0, 1]}})", "/camera/target", "[0,0,1]", "away from the origin", ""},
    {R"({"camera": {"origin": [0, 0, 9], "target": [0, 0, 1]}})", "/camera", "an 'up' along the view", "across the view", "another axis"},
    {R"({"camera": {"origin": [0, 0, 9], "target": [0, 1, 1], "up": [0, 0, 0]}})", "/camera/up", "[0,0,0]", "not 0", ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "fov": 180}})", "/camera/fov", "180", "below 180 degrees", ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "fov": 0}})", "/camera/fov", "0", "above 0", ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "fovy": 40}})", "/camera", "'fovy'", "fov", "did you mean 'fov'?"},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "width": 4}})", "/camera", "'width'", "one of aperture", ""},
    {R"({"camera": {"kind": "orthographic", "origin": [0, 1, 0], "target": [0, 0, 0]}})", "/camera", "no key 'width'", "'width'", ""},
    {R"({"camera": {"kind": "orthographic", "origin": [0, 1, 0], "target": [0, 0, 0], "width": 1, "fov": 40}})", "/camera", "'fov'", "width", ""},
    {R"({"camera": {"kind": "fisheye", "origin": [0, 1, 0], "target": [0, 0, 0]}})", "/camera/kind", "\"fisheye\"", "perspective, orthographic", ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "aperture": -1}})", "/camera/aperture", "-1", "at least 0", ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "focus": true}})", "/camera/focus", "true", "a number", ""},
    {R"("lights": {"kind": "constant"})", "/lights", "{\"kind\":\"constant\"}", "a list", ""},
    {R"("lights": [{"radiance": 1}])", "/lights/0", "no key 'kind'", "the key 'kind'", ""},
    {R"("lights": [{"kind": "constant"}, {"kind": "sun"}])", "/lights/1/kind", "\"sun\"", "distant", ""},
    {R"("lights": [{"kind": "constant", "radiance": -1}])", "/lights/0/radiance", "-1", "0..", ""},
    {R"("lights": [{"kind": "constant", "radiance": 1e39}])", "/lights/0/radiance", "1e+39", "0..3.4", ""},
    {R"("lights": [{"kind": "constant", "radiance": [1, 2]}])", "/lights/0/radiance", "[1,2]", "one number or three", ""},
    {R"("lights": [{"kind": "constant", "radiance": [1, 2, "3"]}])", "/lights/0/radiance/2", "\"3\"", "a number", ""},
    {R"("lights": [{"kind": "constant", "irradiance": 1}])", "/lights/0", "'irradiance'", "radiance", "did you mean 'radiance'?"},
    {R"("lights": [{"kind": "environment"}])", "/lights/0", "no key 'file'", "'file'", ""},
    {R"("lights": [{"kind": "environment", "file": ""}])", "/lights/0/file", "\"\"", "the path of a file", ""},
    {R"("lights": [{"kind": "environment", "file": "a.exr", "up": [0, 0, 0]}])", "/lights/0/up", "[0,0,0]", "not 0", ""},
    {R"("lights": [{"kind": "distant", "direction": [0, 0, 0]}])", "/lights/0/direction", "[0,0,0]", "not 0", ""},
    {R"("lights": [{"kind": "distant", "direction": [0, 0, 1], "angle": 181}])", "/lights/0/angle", "181", "0..180", ""},
    {R"("lights": [{"kind": "rectangle", "corner": [0, 0, 0], "edges": [[1, 0, 0], [2, 0, 0]]}])", "/lights/0/edges", "[[1,0,0],[2,0,0]]", "span an area", ""},
    {R"("lights": [{"kind": "rectangle", "corner": [0, 0, 0], "edges": [[1, 0, 0]]}])", "/lights/0/edges", "[[1,0,0]]", "a list of 2", ""},
    {R"("lights": [{"kind": "sphere", "center": [0, 0, 0], "radius": 0}])", "/lights/0/radius", "0", "above 0", ""},
    {R"("lights": [{"kind": "sphere", "centre": [0, 0, 0], "radius": 1}])", "/lights/0", "the key 'centre' and no 'center'", "'center'", ""},
    {R"("surfaces": [{"mesh": "a.obj"}])", "/surfaces/0", "no key 'material'", "'material'", ""},
    {R"("surfaces": [{"mesh": 3, "material": {"kind": "lambert"}}])", "/surfaces/0/mesh", "3", "a text in quotes", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": "lambert"}])", "/surfaces/0/material", "\"lambert\"", "an object", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "lambertian"}}])", "/surfaces/0/material/kind", "\"lambertian\"", "lambert, dielectric, conductor", "did you mean 'lambert'?"},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "lambert", "reflectance": 1.2}}])", "/surfaces/0/material/reflectance", "1.2", "0..1", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "lambert", "colour": 1}}])", "/surfaces/0/material", "'colour'", "kind, reflectance", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "lambert", "ior": 1}}])", "/surfaces/0/material", "'ior'", "kind, reflectance", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "dielectric", "ior": 0}}])", "/surfaces/0/material/ior", "0", "0.1..10", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "dielectric", "roughness": 2}}])", "/surfaces/0/material/roughness", "2", "0..1", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "dielectric", "absorption": [0, -1, 0]}}])", "/surfaces/0/material/absorption/1", "-1", "0..", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "dielectric", "tint": 2}}])", "/surfaces/0/material/tint", "2", "0..1", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "conductor", "k": 1}}])", "/surfaces/0/material", "no key 'eta'", "'eta'", ""},
    {R"("grains": {"assembly": {"spheres": []}})", "/grains", "no key 'types'", "'types'", ""},
    {R"("grains": {"types": {}, "assembly": {"spheres": []}})", "/grains/types", "{}", "at least one grain type", ""},
    {R"("grains": {"types": {)" + clay + "}}", "/grains", "no key 'assembly'", "'assembly'", ""},
    {R"("grains": {"types": {"a": {"shape": "cube", "material": {"kind": "lambert"}}}, "assembly": {"spheres": []}})", "/grains/types/a/shape", "\"cube\"", "\"sphere\", {\"mesh\": FILE} or a grain of the library: sugar, brown_sugar", ""},
    {R"("grains": {"types": {"a": {"shape": "brown_suger"}}, "assembly": {"spheres": []}})", "/grains/types/a/shape", "\"brown_suger\"", "white_sand", "did you mean 'brown_sugar'?"},
    {R"("grains": {"types": {"a": {"shape": "spere"}}, "assembly": {"spheres": []}})", "/grains/types/a/shape", "\"spere\"", "\"sphere\"", "did you mean 'sphere'?"},
    {R"("grains": {"types": {"a": {"shape": 3}}, "assembly": {"spheres": []}})", "/grains/types/a/shape", "3", "{\"library\": NAME}", ""},
    {R"("grains": {"types": {"a": {"shape": {"library": "suggar"}}}, "assembly": {"spheres": []}})", "/grains/types/a/shape/library", "\"suggar\"", "sugar", "did you mean 'sugar'?"},
    {R"("grains": {"types": {"a": {"shape": {"library": "sugar", "triangles": 10}}}, "assembly": {"spheres": []}})", "/grains/types/a/shape/triangles", "10", "20..", ""},
    {R"("grains": {"types": {"a": {"shape": {"library": "sugar", "sed": 1}}}, "assembly": {"spheres": []}})", "/grains/types/a/shape", "'sed'", "seed", "did you mean 'seed'?"},
    {R"("grains": {"types": {"a": {"shape": {"library": "sugar", "parameters": {"chip": 1}}}}, "assembly": {"spheres": []}})", "/grains/types/a/shape/parameters", "'chip'", "chips", "did you mean 'chips'?"},
    {R"("grains": {"types": {"a": {"shape": {"library": "sugar", "parameters": {"chips": -1}}}}, "assembly": {"spheres": []}})", "/grains/types/a/shape/parameters/chips", "-1", "0..30", ""},
    {R"("grains": {"unit": "inch", "types": {"a": {"shape": "sugar"}}, "assembly": {"spheres": []}})", "/grains/unit", "\"inch\"", "m, cm, mm, um", ""},
    {R"("grains": {"unit": 0, "types": {"a": {"shape": "sugar"}}, "assembly": {"spheres": []}})", "/grains/unit", "0", "above 0", ""},
    {R"("grains": {"unit": true, "types": {"a": {"shape": "sugar"}}, "assembly": {"spheres": []}})", "/grains/unit", "true", "metres per unit", ""},
    {R"("grains": {"types": {"a": {"shape": {"file": "x.obj"}, "material": {"kind": "lambert"}}}, "assembly": {"spheres": []}})", "/grains/types/a/shape", "no key 'mesh'", "'mesh'", ""},
    {R"("grains": {"types": {"a": {"shape": "sphere"}}, "assembly": {"spheres": []}})", "/grains/types/a", "no key 'material'", "'material'", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {}})", "/grains/assembly", "{}", "\"dump\", \"fill\" or \"spheres\"", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"fill": "a.off"}})", "/grains/assembly", "no key 'tile'", "'tile'", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"fill": "a.off", "tile": "t.vdb", "radius": 0}})", "/grains/assembly/radius", "0", "above 0", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"dump": "a", "spheres": []}})", "/grains/assembly", "'spheres'", "dump", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump"}})", "/grains/assembly", "a.dump", "the key 'types'", "\"types\": {\"1\": \"clay\"}"},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {}}})", "/grains/assembly/types", "{}", "at least one", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"1": "cly"}}})", "/grains/assembly/types/1", "\"cly\"", "clay, stone", "did you mean 'clay'?"},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"one": "clay"}}})", "/grains/assembly/types", "the key 'one'", "a type number", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {" 1": "clay"}}})", "/grains/assembly/types", "the key ' 1'", "a type number", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"01": "clay"}}})", "/grains/assembly/types", "the key '01'", "a type number", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"99999999999": "clay"}}})", "/grains/assembly/types", "the key '99999999999'", "a type number", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"1": "clay"}, "radius": 0}})", "/grains/assembly/radius", "0", "above 0", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"1": "clay"}, "radius": {"1": -2}}})", "/grains/assembly/radius/1", "-2", "0", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"1": "clay"}, "radius": "big"}})", "/grains/assembly/radius", "\"big\"", "a number above 0, or an object", ""},
    {grains_of_two + R"("assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1}]}})", "/grains/assembly/spheres/0", "radius", "the key 'type'", ""},
    {grains_of_two + R"("assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1, "type": "ston"}]}})", "/grains/assembly/spheres/0/type", "\"ston\"", "clay, stone", "did you mean 'stone'?"},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": [{"center": [0, 0, 0], "radius": -1}]}})", "/grains/assembly/spheres/0/radius", "-1", "0", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1e39}]}})", "/grains/assembly/spheres/0/radius", "1e+39", "0..3.4", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": [{"centre": [0, 0, 0], "radius": 1}]}})", "/grains/assembly/spheres/0", "'centre'", "'center'", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": []}, "mixture": {"kind": "perlin"}})", "/grains/mixture", "no key 'types'", "'types'", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": []}, "mixture": {"kind": "perlim"}})", "/grains/mixture/kind", "\"perlim\"", "perlin", "did you mean 'perlin'?"},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": []}, "mixture": "cly"})", "/grains/mixture", "\"cly\"", "clay", "did you mean 'clay'?"},
    {R"("medium": [{"mesh": "slab.off"}])", "/medium/0", "no key 'sigma_t'", "'sigma_t'", ""},
    {R"("medium": [{"sigma_t": 1}])", "/medium/0", "sigma_t", "either the key 'mesh'", "slab.off"},
    {R"("medium": [{"mesh": "slab.off", "vdb": "cloud.vdb"}])", "/medium/0", "cloud.vdb", "either the key 'mesh'", ""},
    {R"("medium": [{"mesh": "slab.off", "sigma_t": -1}])", "/medium/0/sigma_t", "-1", "0..", ""},
    {R"("medium": [{"mesh": "slab.off", "sigma_t": 1, "albedo": 1.5}])", "/medium/0/albedo", "1.5", "0..1", ""},
    {R"("medium": [{"mesh": "slab.off", "sigma_t": 1, "g": 1}])", "/medium/0/g", "1", "above -1 and below 1", ""},
    {R"("medium": [{"mesh": "slab.off", "sigma_t": 1, "density": "rho"}])", "/medium/0", "'density'", "", ""},
    {R"("medium": [{"vdb": "cloud.vdb", "interpolation": "cubic"}])", "/medium/0/interpolation", "cubic", "linear, nearest", ""},
    {R"("integrator": {"grain_pixels": -1})", "/integrator/grain_pixels", "-1", "0..", ""},
    {R"("integrator": {"grain_flights": -1})", "/integrator/grain_flights", "-1", "0..", ""},
    {R"("integrator": {"least_shell": -1})", "/integrator/least_shell", "-1", "0..", ""},
    {R"("integrator": {"grain_depth": -1})", "/integrator/grain_depth", "-1", "0..", ""},
    {R"("integrator": {"medium_form": "wlk"})", "/integrator/medium_form", "wlk", "plain, formula, walk, decay", "did you mean 'walk'?"},
    {R"("integrator": {"kind": "epd"})", "/integrator/kind", "\"epd\"", "auto, ept, ppt, vpt", "did you mean 'ept'?"},
    {R"("integrator": {"kind": "stff"})", "/integrator/kind", "\"stff\"", "auto, ept, ppt, vpt, stf", "did you mean 'stf'?"},
    {R"("integrator": {"shells": "on"})", "/integrator/shells", "\"on\"", "true or false", ""},
    {R"("integrator": {"shells": 1})", "/integrator/shells", "1", "true or false", ""},
    {R"("integrator": {"shels": true})", "/integrator", "'shels'", "shells", "did you mean 'shells'"},
    {R"("integrator": {"stf_form": "difusion"})", "/integrator/stf_form", "\"difusion\"", "full, cosine, hg, interpolated, diffusion", "did you mean 'diffusion'?"},
    {R"("integrator": {"stf_form": 2})", "/integrator/stf_form", "2", "", ""},
    {R"("integrator": {"stf_from": "full"})", "/integrator", "'stf_from'", "stf_form", ""},
    {R"("integrator": {"explicit_grains": -1})", "/integrator/explicit_grains", "-1", "0..", ""},
    {R"("integrator": {"accuracy": "best"})", "/integrator/accuracy", "\"best\"", "reference, high, standard, draft", ""},
    {R"("integrator": {"max_depth": 0})", "/integrator/max_depth", "0", "1..", ""},
    {R"("integrator": "ept")", "/integrator", "\"ept\"", "an object", ""},
    {R"({"$schema": 3})", "/$schema", "3", "a text in quotes", ""},
};

TEST(SceneDescription, WrongScenesAreExplained)
{
    EXPECT_GE(wrong_scenes.size(), 30u);
    for (const Wrong& wrong : wrong_scenes) {
        SCOPED_TRACE(wrong.keys);
        const bool whole = wrong.keys[0] == '{' || wrong.keys[0] == '[';
        const auto error = input_error_of([&] { whole ? read(wrong.keys) : read_with(wrong.keys); });
        ASSERT_TRUE(error);
        EXPECT_EQ(error->place(), "scene.json: " + wrong.path);
        EXPECT_THAT(error->found(), HasSubstr(wrong.found));
        EXPECT_THAT(error->expected(), HasSubstr(wrong.expected));
        EXPECT_THAT(error->hint(), HasSubstr(wrong.hint));
        EXPECT_THAT(std::string(error->what()), testing::AllOf(HasSubstr(error->place()), HasSubstr(error->found()), HasSubstr(error->expected())));
    }
}

TEST(SceneDescription, BrokenJsonIsToldByLineAndColumn)
{
    for (const auto& [text, place] : std::vector<std::pair<std::string, std::string>>{
             {"{\n  \"camera\": {\n    \"fov\" 40\n}}", "scene.json:3:12"}, {"", "scene.json:1:1"}, {"{\"a\": 1e999}", "scene.json"}, {"{\"a\": nan}", "scene.json:1:8"}}) {
        const auto error = input_error_of([&] { read(text); });
        ASSERT_TRUE(error) << text;
        EXPECT_THAT(error->place(), HasSubstr(place)) << text;
    }
}

} // namespace
} // namespace scree
