#include "tests/render/loop/plan_rows.h"

#include "render/scene/scene_description.h"

#include <fmt/format.h>

namespace scree::test {

namespace {

std::string lambert(double reflectance)
{
    return fmt::format(R"({{"kind": "lambert", "reflectance": {}}})", reflectance);
}
const std::string sky = R"("lights": [{"kind": "constant", "radiance": 1}], )";
const std::string glass = R"({"kind": "dielectric", "ior": 1.5})";

/// Spheres of radius 1/4 on a lattice around 0.
std::string lattice(int nx, int ny, int nz, double spacing = 0.5)
{
    std::string list;
    for (int i = 0; i < nx * ny * nz; ++i) {
        list += fmt::format(R"({}{{"center": [{}, {}, {}], "radius": 0.25, "type": "a"}})", i ? ", " : "",
                            spacing * (i % nx - 0.5 * (nx - 1)), spacing * (i / nx % ny - 0.5 * (ny - 1)),
                            spacing * (i / nx / ny - 0.5 * (nz - 1)));
    }
    return R"("assembly": {"spheres": [)" + list + "]}";
}

std::string grains(const std::string& types, const std::string& assembly)
{
    return sky + R"("grains": {"types": {)" + types + "}, " + assembly + "}";
}
std::string type(const std::string& name, const std::string& shape, const std::string& material)
{
    return fmt::format(R"("{}": {{"shape": {}, "material": {}}})", name, shape, material);
}

const Arguments no_arguments, large{"--size", "400x300"}, far{"-D", "camera.origin=[0, -90000, 5]"};
const Arguments all_channels{"--aov", "albedo", "--aov", "normal", "--aov",    "depth", "--aov",
                             "type",  "--aov",  "id",    "--aov",  "variance", "--aov", "samples"};

} // namespace

Arguments with(Arguments a, const Arguments& b)
{
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::map<std::string, std::string> plan_scenes()
{
    const std::string ball = R"("sphere")", mesh = R"({"mesh": "cube.obj"})", ten = lattice(5, 2, 1);
    const std::string grey = type("a", ball, lambert(0.5)), bright = type("a", ball, lambert(0.99));
    const std::string floor = R"(, "surfaces": [{"mesh": "floor.obj", "material": )" + lambert(0.5) + "}]";
    const auto slab = [](const std::string& sigma_t) {
        return R"("medium": [{"mesh": "slab.obj", "albedo": 0.9, "g": 0.5, "sigma_t": )" + sigma_t + "}]";
    };
    const auto filled = [&](const std::string& domain, const std::string& radius, const std::string& more) {
        return grains(bright + more, R"("assembly": {"fill": ")" + domain + R"(", "tile": "tile.vdb", "radius": )" +
                                         radius + R"(, "types": {"0": "a", "1": "a"}})");
    };
    return {
        {"nothing", R"("lights": [])"},
        {"ten", grains(grey, ten)},
        {"ten on a floor", grains(grey, ten) + floor},
        {"cubes", grains(type("a", mesh, lambert(0.5)), ten)},
        {"library", grains(type("a", R"({"library": "sugar", "triangles": 20})", lambert(0.5)), ten)},
        {"unused glass", grains(grey + ", " + type("b", ball, glass), ten) + floor},
        {"no size",
         grains(type("a", mesh, glass), R"("assembly": {"spheres": [{"center": [0, 0, 0], "radius": 0}]})") + floor},
        {"glass on a floor", grains(type("a", ball, glass), ten) + floor},
        {"two colours",
         grains(
             grey + ", " + type("b", ball, lambert(0.7)),
             R"("assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1, "type": "a"}, {"center": [2, 0, 0], "radius": 1, "type": "b"}]})")},
        {"many", grains(bright, lattice(13, 13, 13))},
        {"many cubes", grains(type("a", mesh, lambert(0.99)), lattice(13, 13, 13))},
        {"many dark", grains(grey, lattice(13, 13, 13))},
        {"thin", grains(bright, lattice(46, 46, 1))},
        {"bed", grains(bright, lattice(9, 9, 9))},
        {"apart", grains(bright, lattice(2, 2, 2, 8))},
        {"slab", sky + slab("5")},
        {"thin slab", sky + slab("0.001")},
        {"coloured slab", sky + slab("[4, 5, 6]")},
        {"slab among grains", grains(grey, ten) + ", " + slab("5")},
        {"slab and bed", grains(bright, lattice(9, 9, 9)) + ", " + slab("5")},
        {"slab around a light",
         R"("lights": [{"kind": "sphere", "center": [0, 0, -0.5], "radius": 0.1, "radiance": 1}], )" + slab("5")},
        {"cloud", sky + R"("medium": [{"vdb": "cloud.vdb", "scale": 5, "albedo": 0.9}])"},
        {"dense cloud", sky + R"("medium": [{"vdb": "cloud.vdb", "scale": 20, "albedo": 0.9995, "g": 0.9}])"},
        {"denser cloud", sky + R"("medium": [{"vdb": "cloud.vdb", "scale": 200, "albedo": 0.9995, "g": 0.9}])"},
        {"empty cloud", sky + R"("medium": [{"vdb": "empty.vdb"}])"},
        {"lamp",
         R"("lights": [{"kind": "rectangle", "corner": [0, 0, 9], "edges": [[1, 0, 0], [0, 1, 0]], "radiance": 10}])"},
        {"sky map", R"("lights": [{"kind": "environment", "file": "sky.exr"}])"},
        {"fill", filled("ball.obj", "0.07", "")},
        {"fill of one type", filled("ball.obj", "0.07", ", " + type("b", mesh, glass))},
        {"fill of a mixture",
         R"("lights": [], "grains": {"types": {)" + bright + ", " + type("b", ball, lambert(0.5)) + ", " +
             type("c", mesh, glass) +
             R"(}, "mixture": {"kind": "random", "types": ["a", "b", "c"], "weights": [1, 1, 0]}, "assembly": {"fill": "ball.obj", "tile": "tile.vdb", "radius": 0.07}})"},
        {"pattern",
         R"("lights": [], "grains": {"types": {)" + bright + ", " + type("b", ball, lambert(0.5)) +
             R"(}, "mixture": {"kind": "perlin", "types": ["a", "b"], "scale": 1}, "assembly": {"fill": "slab.obj", "tile": "tile.vdb", "radius": 0.07}})"},
    };
}

std::vector<PlanRow> plan_rows()
{
    std::vector<PlanRow> rows;
    const auto planned = [&](const std::string& name, const std::string& scene, const Arguments& arguments,
                             const std::string& part, bool built, const std::string& reason) {
        rows.push_back({name, scene, with(arguments, plan_only), part, built, reason});
    };
    const auto traced = [&](const std::string& name, const std::string& scene, const Arguments& arguments,
                            const std::string& part, bool built, const std::string& reason) {
        rows.push_back({name, scene, arguments, part, built, reason});
    };
    const std::string medium = "medium of the grains", walk = "walk in the packing",
                      distances = "distances within media", inside = "surfaces inside grains";

    // Without grains, media, lights.
    for (const char* part : {"explicit grains", "proxies", "medium of the grains"}) {
        for (const Arguments& how : {no_arguments, ept, ppt, vpt, stf})
            planned("no grains", "nothing", how, part, false, "the scene has no grains");
    }
    for (const char* part : {"grains", "surfaces", "medium"})
        planned("nothing", "nothing", {}, part, false, "the scene has none");
    for (const auto& part : {distances, std::string("shells")})
        planned("no medium", "nothing", stf, part, false, "there is no medium");
    planned("no map", "nothing", {}, "environment map", false, "no light has one");
    planned("no light", "nothing", {}, "light sampling", false, "the scene has no light");
    planned("no grains", "nothing", {}, inside, false, "no path inside a grain can hit a surface");
    planned("a structure", "nothing", {}, "acceleration structure", true, "to be built by Embree");
    traced("a structure", "nothing", {}, "acceleration structure", true, "Embree");
    for (const std::string& channel : aov_names.words()) {
        planned("not asked", "nothing", {}, "channels " + channel, false, "not asked for");
        planned("asked", "nothing", all_channels, "channels " + channel, true, "asked for");
    }

    // Why grains are explicit geometry, or are not.
    planned("few", "ten", {}, "explicit grains", true,
            "every grain is traced as explicit geometry: there are fewer than 2000");
    planned("few", "ten", {}, "proxies", false, "every grain is traced as explicit geometry");
    planned("ept", "ten", ept, "explicit grains", true, "every grain is traced as explicit geometry");
    planned("reference", "many", {"--accuracy", "reference"}, "explicit grains", true, "the accuracy is reference");
    planned("dark", "many dark", {}, "explicit grains", true, "light hits about 1.4 grains");
    planned("ppt", "ten", ppt, "explicit grains", false, "proxies replace every grain");
    planned("ppt", "ten", ppt, "proxies", true, "after 0 grains of a path");
    planned("ppt and grains", "ten", with(ppt, {"--explicit-grains", "2"}), "explicit grains", true,
            "proxies replace all grains except the first 2 of a path");
    planned("ppt and grains", "ten", with(ppt, {"--explicit-grains", "2"}), "proxies", true,
            "after 2 grains of a path");
    planned("bright", "many", large, "proxies", true, "after 1 grains of a path");
    planned("bright", "many", large, "explicit grains", true, "proxies replace all grains except the first of a path");
    planned("draft", "many", draft, "explicit grains", false, "the accuracy is draft");
    planned("far", "many", far, "explicit grains", false, "pixels wide");
    planned("asked", "ten", with(draft, {"--explicit-grains", "3"}), "explicit grains", true,
            "the first 3 of a path, as asked for");
    planned("asked", "ten", with(draft, {"--explicit-grains", "0"}), "explicit grains", false,
            "proxies replace every grain, as asked for");
    planned("vpt", "bed", vpt, "explicit grains", false, "a medium replaces all grains");
    planned("vpt", "bed", vpt, "proxies", false, "a medium replaces all grains");

    // What is built for a type.
    planned("spheres", "ten", {}, "exemplar 'a'", false, "its shape is the bounding sphere itself");
    planned("unused", "unused glass", {}, "exemplar 'b'", false, "no grain has this type");
    planned("unused", "unused glass", ppt, "gsdf 'b'", false, "no grain has this type");
    planned("no size", "no size", ppt, "gsdf 'a'", false, "no grain has this type");
    planned("no size", "no size", ept, "exemplar 'a'", false, "no grain has this type");
    planned("no size", "no size", {}, inside, false, "no path");
    planned("cubes", "cubes", {}, "exemplar 'a'", true, "12 triangles");
    planned("library", "library", {}, "exemplar 'a'", true, "triangles of the library's sugar");
    for (const char* part : {"exemplar 'b'", "gsdf 'b'"})
        planned("not in the tile", "fill of one type", ppt, part, false, "no grain has this type");
    for (const char* part : {"exemplar 'c'", "gsdf 'c'"})
        planned("not in the mixture", "fill of a mixture", ppt, part, false, "no grain has this type");
    planned("in the mixture", "fill of a mixture", ppt, "gsdf 'b'", true, "to be traced");
    planned("no proxies", "cubes", {}, "gsdf 'a'", false, "no grain is a proxy, and no medium replaces grains");
    for (const Arguments& how : {ppt, vpt, stf}) {
        planned("only for gsdfs", "cubes", how, "exemplar 'a'", false, "no grain is traced as explicit geometry");
        planned("to be traced", "cubes", how, "gsdf 'a'", true, "to be traced to an error of 8 %; not in the cache");
    }
    for (const Arguments& how : {draft, far})
        planned("never as they are", "many cubes", how, "exemplar 'a'", false,
                "no grain is traced as explicit geometry");
    planned("the first", "many cubes", large, "exemplar 'a'", true, "12 triangles");
    traced("made once", "two colours", ppt, "gsdf 'a'", true, "traced, ");
    traced("made once", "two colours", ppt, "gsdf 'b'", true, "already made for another type or frame");
    traced("again", "ten", ppt, "gsdf 'a'", true, "from the cache, ");
    planned("again", "ten", with(ppt, {"--seed", "2"}), "gsdf 'a'", true, "from the cache, ");
    traced("grains", "ten", {}, "grains", true, "10 of 10 spheres read");
    const Arguments crop{"--cropwindow", "0,0.5,0,1"};
    planned("crop", "ten", crop, "grains outside the crop", true, "kept: they may scatter light into the crop");
    traced("crop", "ten", crop, "grains outside the crop", true, "kept: they may scatter light into the crop");
    planned("crop", "fill", crop, "grains outside the crop", false,
            "no grain is listed: rays find the grains they hit");
    planned("crop", "bed", with(vpt, crop), "grains outside the crop", false, "a medium replaces all grains");
    planned("crop", "slab", crop, "grains outside the crop", false, "the scene has no grains");
    planned("fill", "fill", {}, "domain", true, "320 triangles, checked");
    planned("fill", "fill", {}, "tile", true, "tile.vdb: 64 spheres, 1 variants");
    planned("fill", "fill", {}, "fill", true, "spheres of mean radius 0.07");

    // Surfaces and lights.
    planned("floor", "ten on a floor", {}, "surfaces", true, "1 meshes, 2 triangles");
    planned("opaque", "ten on a floor", {}, inside, false, "no path inside a grain can hit a surface");
    planned("glass", "glass on a floor", {}, inside, true, "a second structure of the surfaces");
    planned("through proxies", "ten on a floor", ppt, inside, true, "a second structure of the surfaces");
    planned("no grain left", "glass on a floor", vpt, inside, false, "no path");
    planned("unused glass", "unused glass", {}, inside, false, "no path");
    planned("constant", "ten", {}, "light sampling", false, "only constant or black lights");
    planned("lamp", "lamp", {}, "light sampling", true, "next-event estimation");
    planned("map", "sky map", {}, "environment map", true, "sky.exr");
    traced("map", "sky map", {}, "environment map", true, "sky.exr");

    // Media that replace grains.
    planned("everywhere grains", "ten", {}, medium, false, "the integrator traces grains everywhere");
    planned("thin", "thin", {}, medium, false, "few grains lie 4 mean radii deep");
    planned("not as deep", "bed", with(ept, {"--grain-depth", "100"}), medium, false,
            "no place is 100 mean radii deep");
    planned("not as deep", "bed", with(ept, {"--grain-depth", "100"}), "gsdf 'a'", false, "no grain is a proxy");
    planned("deep", "many", draft, medium, true, "to be made where a place lies 2 mean radii below every face");
    planned("all", "bed", vpt, medium, true, "to be made, in place of all grains");
    planned("all", "bed", vpt, walk, true, "to be walked");
    planned("all", "bed", with(vpt, formula), walk, false, "the form of the medium needs none");
    traced("all", "bed", vpt, walk, true, "scatterings, transport length to");
    traced("all", "bed", vpt, medium, true, "as the grains vary");
    traced("all", "bed", with(vpt, formula), walk, false, "the form of the medium needs none");
    traced("fill", "fill", with(vpt, formula), medium, true, "the same everywhere");
    traced("pattern", "pattern", with(vpt, formula), medium, true, "as the grains vary");
    traced("apart", "apart", with(ept, {"--accuracy", "draft", "--grain-depth", "3"}), medium, false,
           "no place is 3 mean radii deep");
    traced("apart", "apart", with(ept, {"--accuracy", "draft", "--grain-depth", "3"}), walk, false,
           "no medium is made from it");
    traced("apart", "apart", vpt, medium, false, "no grain lies deeper than one radius");
    traced("apart", "apart", stf, "shells", false, "there is no medium");

    // Media of the scene, and shells and distances in all media.
    planned("slab", "slab", {}, "medium 'slab.obj'", true, "the same everywhere, within 12 triangles");
    planned("cloud", "cloud", {}, "medium 'cloud.vdb'", true, "to be read");
    planned("empty", "empty cloud", {}, "medium 'empty.vdb'", false, "its grid is empty");
    planned("empty", "empty cloud", {}, "shells", false, "there is no medium");
    planned("empty", "empty cloud", {}, distances, false, "there is no medium");
    planned("to come", "slab", {}, distances, true, "to be computed");
    planned("to come", "cloud", {}, "shells", true, "to be made where a shell of 8 mean free paths fits in a medium");
    planned("to come", "cloud", {}, "shells", true, "fits in a medium and, in grids, where they save work");
    planned("to come", "slab", stf, "shells", true, "to be made where a shell of 1 mean free paths fits in a medium");
    planned("to come", "slab", {"--least-shell", "2"}, "shells", true,
            "to be made where a shell of 2 mean free paths fits in a medium");
    planned("to come", "bed", stf, "shells", true, "to be made");
    planned("small shells", "slab", {}, "shells", false,
            "no shell can be larger than 2.5 mean free paths; at least 8 are needed");
    planned("thin", "thin slab", stf, "shells", false,
            "no shell can be larger than 0.0005 mean free paths; at least 1 are needed");
    planned("coloured", "coloured slab", stf, "shells", false, "the extinction of every medium depends on the channel");
    planned("stepwise", "slab", vpt, "shells", false, "light in media is traced from scattering to scattering");
    planned("among grains", "slab among grains", {}, distances, false,
            "grains or a sphere light may lie inside a medium");
    planned("among grains", "slab among grains", {}, "shells", false,
            "grains or a sphere light may lie inside a medium");
    planned("among no grains any more", "slab and bed", stf, "shells", true, "to be made");
    traced("slab", "slab", draft, distances, true, "to everything that a ray can hit there");
    const Arguments shells{"--shells", "on"};
    traced("slab", "slab", with(with(draft, shells), diffusion), "shells of 'slab.obj'", true,
           "mean free paths for 1 values of g, 0 made now");
    traced("slab", "slab", with(draft, shells), "shells of 'slab.obj'", true,
           "mean free paths for 1 values of g, 3 made now");
    traced("small shells", "slab", draft, "shells of 'slab.obj'", false, "at least 8 are needed");
    traced("slab", "slab", vpt, "shells", false, "light in media is traced from scattering to scattering");
    traced("slab", "slab", vpt, distances, true, "to everything that a ray can hit there");
    traced("coloured", "coloured slab", stf, "shells of 'slab.obj'", false, "its extinction depends on the channel");
    traced("thin", "thin slab", stf, "shells of 'slab.obj'", false, "none fits: no place is a mean free path away");
    traced("among grains", "slab among grains", draft, distances, false,
           "grains or a sphere light may lie inside a medium");
    traced("among grains", "slab among grains", draft, "shells of 'slab.obj'", false,
           "grains or a sphere light may lie inside a medium");
    traced("around a light", "slab around a light", draft, "shells of 'slab.obj'", false,
           "grains or a sphere light may lie inside a medium");
    traced("cloud", "cloud", with(draft, diffusion), "medium 'cloud.vdb'", true, "from grids");
    traced("cloud", "cloud", with(with(draft, shells), diffusion), "shells of 'cloud.vdb'", true, "for 1 values of g");
    traced("save nothing", "dense cloud", with(draft, diffusion), "shells of 'cloud.vdb'", false,
           "of the work; at most 95 % is worthwhile");
    traced("save work", "denser cloud", with(draft, diffusion), "shells of 'cloud.vdb'", true, "a shell, for ");
    for (const Arguments& asked : {Arguments{"--least-shell", "8"}, shells})
        traced("asked for", "dense cloud", with(with(draft, asked), diffusion), "shells of 'cloud.vdb'", true,
               "0 made now");
    traced("of grains", "bed", with(with(stf, diffusion), formula), "shells of 'medium of the grains'", true,
           "values of g");
    traced("empty", "empty cloud", draft, "shells", false, "there is no medium");
    return rows;
}

} // namespace scree::test
