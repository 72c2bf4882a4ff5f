// The scene file: every key with its default and unit.

#include "tests/builders/scene_texts.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace scree {
namespace {

using namespace test;

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
    const CameraDescription p =
        read(
            R"({"$schema": "scene.schema.json", "camera": {"kind": "perspective", "origin": [1, 2, 3], "target": [4, 5, 6],
        "up": [0, 1, 0], "fov": 60.5, "aperture": 0.25, "focus": 12}})")
            .camera;
    EXPECT_EQ(p.origin, V3d(1, 2, 3));
    EXPECT_EQ(p.target, V3d(4, 5, 6));
    EXPECT_EQ(p.up, V3d(0, 1, 0));
    EXPECT_EQ(p.fov, 60.5);
    EXPECT_EQ(p.aperture, 0.25);
    EXPECT_EQ(p.focus, 12);
    const CameraDescription o =
        read(
            R"({"camera": {"kind": "orthographic", "origin": [1e7, 2, 3], "target": [4, 5, 6], "width": 20, "aperture": 1, "focus": 2}})")
            .camera;
    EXPECT_EQ(o.kind, CameraKind::orthographic);
    EXPECT_EQ(o.width, 20);
    EXPECT_EQ(o.origin.x, 1e7);
    EXPECT_EQ(o.focus, 2);
}

TEST(SceneDescription, ReadsFilms)
{
    const FilmDescription film =
        read_with(
            R"("film": {"size": [64, 48.0], "filter": "box", "aov": ["albedo", "normal", "depth", "type", "id", "variance", "samples", "depth"]})")
            .film;
    EXPECT_EQ(film.width, 64);
    EXPECT_EQ(film.height, 48);
    EXPECT_EQ(film.filter.kind, FilterKind::box);
    EXPECT_EQ(film.filter.radius, 0.5);
    EXPECT_EQ(film.aov, (std::vector<Aov>{Aov::albedo, Aov::normal, Aov::depth, Aov::type, Aov::id, Aov::variance,
                                          Aov::samples}));
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
        {"kind": "sphere", "center": [3, 2, 1], "radius": 0.5}])")
                            .lights;
    ASSERT_EQ(lights.size(), 8u);
    EXPECT_EQ(lights[0].radiance, Color(1));
    EXPECT_EQ(lights[1].radiance, Color(1, 2, 3));
    EXPECT_EQ(lights[2].file, "/scenes/here/sky.exr");
    EXPECT_EQ(lights[2].scale, Color(1));
    EXPECT_EQ(lights[2].up, V3d(0, 0, 1));
    EXPECT_EQ(lights[3].file, "/abs/sky.exr");
    EXPECT_EQ(lights[3].scale, Color(2));
    EXPECT_EQ(lights[3].up, V3d(0, 1, 0));
    EXPECT_EQ(lights[4].direction, V3d(1, 2, -3));
    EXPECT_EQ(lights[4].irradiance, Color(1));
    EXPECT_EQ(lights[4].angle, 0.53);
    EXPECT_EQ(lights[5].irradiance, Color(3, 2, 1));
    EXPECT_EQ(lights[5].angle, 0);
    EXPECT_EQ(lights[6].corner, V3d(1, 2, 3));
    EXPECT_EQ(lights[6].edge1, V3d(1, 0, 0));
    EXPECT_EQ(lights[6].edge2, V3d(0, 2, 0));
    EXPECT_EQ(lights[6].radiance, Color(10));
    EXPECT_EQ(lights[7].center, V3d(3, 2, 1));
    EXPECT_EQ(lights[7].radius, 0.5);
    EXPECT_EQ(lights[7].radiance, Color(1));
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
        {"mesh": "g.obj", "material": {"kind": "dielectric", "ior": 1, "roughness": 0.5}}])")
                              .surfaces;
    ASSERT_EQ(surfaces.size(), 7u);
    EXPECT_EQ(surfaces[0].mesh, "/scenes/here/a.obj");
    EXPECT_EQ(surfaces[0].material.kind, MaterialKind::lambert);
    EXPECT_EQ(surfaces[0].material.reflectance, Color(0.5f));
    EXPECT_EQ(surfaces[1].mesh, "/scenes/here/../b.ply");
    EXPECT_EQ(surfaces[1].material.reflectance, Color(0.1f, 0.2f, 1));
    const Material& glass = surfaces[2].material;
    EXPECT_EQ(glass.kind, MaterialKind::dielectric);
    EXPECT_EQ(glass.ior, 1.5);
    EXPECT_EQ(glass.alpha, 0);
    EXPECT_EQ(glass.absorption, Color(0.0f));
    EXPECT_EQ(glass.tint, Color(1));
    EXPECT_EQ(surfaces[3].material.ior, 1.31);
    EXPECT_EQ(surfaces[3].material.alpha, 0.25) << "the GGX width is the square of the roughness";
    EXPECT_EQ(surfaces[3].material.absorption, Color(1, 2, 3)) << "per unit of length of the scene";
    EXPECT_EQ(surfaces[3].material.tint, Color(0.98f));
    EXPECT_EQ(surfaces[4].material.kind, MaterialKind::conductor);
    EXPECT_EQ(surfaces[4].material.eta, Color(0.2f, 0.9f, 1.1f));
    EXPECT_EQ(surfaces[4].material.k, Color(3.9f));
    EXPECT_EQ(surfaces[5].material.alpha, 1);
    EXPECT_EQ(surfaces[5].material.tint, Color(1, 0.5f, 0));
    EXPECT_EQ(surfaces[6].material.alpha, 0) << "without a step in the index there is nothing to be rough";
}

TEST(SceneDescription, ReadsGrainsFromADump)
{
    const SceneDescription scene = read_with(
        R"("grains": {"types": {)" + stone + ", " + clay +
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
    const auto one =
        read_with(R"("grains": {"types": {)" + clay + R"(}, "assembly": {"dump": "a.dump", "radius": 0.25}})").assembly;
    EXPECT_TRUE(one->types.empty());
    EXPECT_EQ(one->radius, 0.25);
}

TEST(SceneDescription, ReadsGrainsWrittenOut)
{
    const auto one =
        read_with(
            R"("grains": {"types": {)" + clay +
            R"(}, "assembly": {"spheres": [{"center": [1, 2, 3], "radius": 0.5}, {"center": [0, 0, 0], "radius": 0}]}})")
            .assembly;
    ASSERT_EQ(one->spheres.size(), 2u);
    EXPECT_EQ(one->spheres[0].center, V3d(1, 2, 3));
    EXPECT_EQ(one->spheres[0].radius, 0.5);
    EXPECT_EQ(one->spheres[0].type, "");
    const auto two =
        read_with(R"("grains": {"types": {)" + clay + ", " + stone +
                  R"(}, "assembly": {"spheres": [{"center": [1, 2, 3], "radius": 0.5, "type": "stone"}]}})")
            .assembly;
    EXPECT_EQ(two->spheres[0].type, "stone");
    EXPECT_TRUE(
        read_with(R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": []}})").assembly->spheres.empty());
}

GrainTypeDescription read_type(const std::string& type, const std::string& before = "")
{
    return read_with(R"("grains": {)" + before + R"("types": {"a": )" + type + R"(}, "assembly": {"spheres": []}})")
        .types[0];
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
    const GrainTypeDescription fine =
        read_type(R"({"shape": {"library": "brown_sugar", "triangles": 5000, "seed": 7, "parameters": {"chips": 2}}})");
    EXPECT_EQ(fine.library, &sugar);
    EXPECT_EQ(fine.shape.triangles, 5000u);
    EXPECT_EQ(fine.shape.seed, 7u);
    EXPECT_EQ(fine.shape.parameters, (std::map<std::string, double>{{"chips", 2}}));
    // A material of the scene replaces the library's.
    const GrainTypeDescription clay_sugar =
        read_type(R"({"shape": "brown_sugar", "material": {"kind": "lambert", "reflectance": 0.25}})");
    EXPECT_EQ(clay_sugar.library, &sugar);
    EXPECT_EQ(clay_sugar.material.kind, MaterialKind::lambert);
    EXPECT_EQ(clay_sugar.material.reflectance, Color(0.25f));
    // Spheres are meshes only if `triangles` is set.
    EXPECT_FALSE(read_type(R"({"shape": "diffuse_sphere"})").has_mesh());
    EXPECT_TRUE(read_type(R"({"shape": {"library": "diffuse_sphere", "triangles": 80}})").has_mesh());
}

TEST(SceneDescription, UnitsConvertTheLibrarysAbsorptionOnly)
{
    const Color per_metre = find_library_grain("brown_sugar")->material.absorption;
    ASSERT_GT(per_metre.x, 0);
    for (const auto& [unit, metres] : std::vector<std::pair<std::string, float>>{{"", 1e-3f},
                                                                                 {R"("unit": "mm", )", 1e-3f},
                                                                                 {R"("unit": "m", )", 1},
                                                                                 {R"("unit": "cm", )", 1e-2f},
                                                                                 {R"("unit": "um", )", 1e-6f},
                                                                                 {R"("unit": 0.5, )", 0.5f}}) {
        const Color found = read_type(R"({"shape": "brown_sugar"})", unit).material.absorption;
        for (int i = 0; i < 3; ++i) EXPECT_FLOAT_EQ(found[i], metres * per_metre[i]) << unit;
        EXPECT_EQ(
            read_type(R"({"shape": "brown_sugar", "material": {"kind": "dielectric", "absorption": [1, 2, 3]}})", unit)
                .material.absorption,
            Color(1, 2, 3));
    }
}

TEST(SceneDescription, ReadsIntegrators)
{
    const SceneDescription scene =
        read_with(R"("medium": [], "integrator": {"kind": "ept", "accuracy": "reference", "max_depth": 7})");
    EXPECT_EQ(scene.integrator.kind, IntegratorKind::ept);
    EXPECT_EQ(scene.integrator.accuracy, Accuracy::reference);
    EXPECT_EQ(scene.integrator.max_depth, 7u);
    EXPECT_EQ(read_with(R"("integrator": {})").integrator.kind, IntegratorKind::automatic);
    EXPECT_EQ(read_with(R"("integrator": {"kind": "ppt", "explicit_grains": 2})").integrator.explicit_grains, 2u);
    const IntegratorDescription switches =
        read_with(R"("integrator": {"grain_pixels": 0.5, "grain_flights": 2, "least_shell": 4})").integrator;
    EXPECT_EQ(switches.grain_pixels, 0.5);
    EXPECT_EQ(switches.grain_flights, 2);
    EXPECT_EQ(switches.least_shell, 4);
    EXPECT_FALSE(IntegratorDescription().grain_pixels || IntegratorDescription().grain_flights ||
                 IntegratorDescription().least_shell);
    EXPECT_FALSE(scene.integrator.shells) << "left to the integrator";
    EXPECT_EQ(scene.integrator.stf_form, StfForm::full);
    const IntegratorDescription stf =
        read_with(R"("integrator": {"kind": "stf", "shells": false, "stf_form": "diffusion"})").integrator;
    EXPECT_EQ(stf.kind, IntegratorKind::stf);
    EXPECT_EQ(stf.shells, std::optional(false));
    EXPECT_EQ(stf.stf_form, StfForm::diffusion);
    EXPECT_EQ(read_with(R"("integrator": {"shells": true})").integrator.shells, std::optional(true));
    for (const auto& [name, form] : {std::pair{"full", StfForm::full},
                                     {"cosine", StfForm::cosine},
                                     {"hg", StfForm::hg},
                                     {"interpolated", StfForm::interpolated}}) {
        EXPECT_EQ(read_with(fmt::format(R"("integrator": {{"stf_form": "{}"}})", name)).integrator.stf_form, form);
    }
}

TEST(SceneDescription, ReadsMedia)
{
    const SceneDescription scene =
        read_with(R"("medium": [{"mesh": "slab.off", "sigma_t": [1, 2, 3], "albedo": 0.9, "g": -0.5},
        {"vdb": "cloud.vdb", "density": "rho", "scale": 10, "albedo": "colour", "g": 0.85, "interpolation": "nearest"}], "integrator": {"kind": "vpt", "grain_depth": 4, "medium_form": "walk"})");
    ASSERT_EQ(scene.media.size(), 2u);
    EXPECT_EQ(scene.media[0].mesh.filename(), "slab.off");
    EXPECT_EQ(scene.media[0].sigma_t, Color(1, 2, 3));
    EXPECT_EQ(scene.media[0].albedo, Weight(0.9));
    EXPECT_EQ(scene.media[0].g, -0.5);
    EXPECT_EQ(scene.media[1].vdb.filename(), "cloud.vdb");
    EXPECT_EQ(scene.media[1].density, "rho");
    EXPECT_EQ(scene.media[1].sigma_t, Color(10));
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
    EXPECT_EQ(read("// A comment\n" + text).canonical,
              read(R"({"film": /* here */ {"size":[4,3]}, )" + camera + "}").canonical);
    EXPECT_NE(read(text).canonical, read("{" + camera + R"(, "film": {"size": [3, 4]}})").canonical);
}

} // namespace
} // namespace scree
