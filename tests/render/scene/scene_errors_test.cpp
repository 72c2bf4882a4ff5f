// The messages about errors in a scene file, and the places they name.

#include "tests/builders/scene_texts.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>

namespace scree {
namespace {

using namespace test;
using testing::HasSubstr;

struct Wrong {
    std::string keys; ///< after the camera; or a whole scene when it starts with {
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
    {R"("film": {"filter": "gausian"})", "/film/filter", "\"gausian\"", "box, tent, gaussian",
     "did you mean 'gaussian'?"},
    {R"("film": {"filter": {"kind": "box", "radius": 0}})", "/film/filter/radius", "0", "a number above 0", ""},
    {R"("film": {"filter": {"radius": 1}})", "/film/filter", "no key 'kind'", "the key 'kind'", ""},
    {R"("film": {"filter": 3})", "/film/filter", "3", "an object", ""},
    {R"("film": {"aov": ["norml"]})", "/film/aov/0", "\"norml\"", "albedo, normal", "did you mean 'normal'?"},
    {R"("film": {"aov": "normal"})", "/film/aov", "\"normal\"", "a list", ""},
    {R"({"camera": {"target": [0, 0, 1]}})", "/camera", "no key 'origin'", "the key 'origin'", ""},
    {R"({"camera": {"origin": [0, 0], "target": [0, 0, 1]}})", "/camera/origin", "[0,0]", "a list of 3", ""},
    {R"({"camera": {"origin": [0, "a", 0], "target": [0, 0, 1]}})", "/camera/origin/1", "\"a\"", "a number", ""},
    {R"({"camera": {"origin": [0, 0, 1], "target": [0, 0, 1]}})", "/camera/target", "[0,0,1]",
     "that differs from the origin", ""},
    {R"({"camera": {"origin": [0, 0, 9], "target": [0, 0, 1]}})", "/camera", "an 'up' parallel to the view",
     "not parallel to the view", "another axis"},
    {R"({"camera": {"origin": [0, 0, 9], "target": [0, 1, 1], "up": [0, 0, 0]}})", "/camera/up", "[0,0,0]", "not 0",
     ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "fov": 180}})", "/camera/fov", "180", "below 180 degrees",
     ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "fov": 0}})", "/camera/fov", "0", "above 0", ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "fovy": 40}})", "/camera", "'fovy'", "fov",
     "did you mean 'fov'?"},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "width": 4}})", "/camera", "'width'", "one of aperture",
     ""},
    {R"({"camera": {"kind": "orthographic", "origin": [0, 1, 0], "target": [0, 0, 0]}})", "/camera", "no key 'width'",
     "'width'", ""},
    {R"({"camera": {"kind": "orthographic", "origin": [0, 1, 0], "target": [0, 0, 0], "width": 1, "fov": 40}})",
     "/camera", "'fov'", "width", ""},
    {R"({"camera": {"kind": "fisheye", "origin": [0, 1, 0], "target": [0, 0, 0]}})", "/camera/kind", "\"fisheye\"",
     "perspective, orthographic", ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "aperture": -1}})", "/camera/aperture", "-1",
     "at least 0", ""},
    {R"({"camera": {"origin": [0, 1, 0], "target": [0, 0, 0], "focus": true}})", "/camera/focus", "true", "a number",
     ""},
    {R"("lights": {"kind": "constant"})", "/lights", "{\"kind\":\"constant\"}", "a list", ""},
    {R"("lights": [{"radiance": 1}])", "/lights/0", "no key 'kind'", "the key 'kind'", ""},
    {R"("lights": [{"kind": "constant"}, {"kind": "sun"}])", "/lights/1/kind", "\"sun\"", "distant", ""},
    {R"("lights": [{"kind": "constant", "radiance": -1}])", "/lights/0/radiance", "-1", "0..", ""},
    {R"("lights": [{"kind": "constant", "radiance": 1e39}])", "/lights/0/radiance", "1e+39", "0..3.4", ""},
    {R"("lights": [{"kind": "constant", "radiance": [1, 2]}])", "/lights/0/radiance", "[1,2]", "one number or three",
     ""},
    {R"("lights": [{"kind": "constant", "radiance": [1, 2, "3"]}])", "/lights/0/radiance/2", "\"3\"", "a number", ""},
    {R"("lights": [{"kind": "constant", "irradiance": 1}])", "/lights/0", "'irradiance'", "radiance",
     "did you mean 'radiance'?"},
    {R"("lights": [{"kind": "environment"}])", "/lights/0", "no key 'file'", "'file'", ""},
    {R"("lights": [{"kind": "environment", "file": ""}])", "/lights/0/file", "\"\"", "the path of a file", ""},
    {R"("lights": [{"kind": "environment", "file": "a.exr", "up": [0, 0, 0]}])", "/lights/0/up", "[0,0,0]", "not 0",
     ""},
    {R"("lights": [{"kind": "distant", "direction": [0, 0, 0]}])", "/lights/0/direction", "[0,0,0]", "not 0", ""},
    {R"("lights": [{"kind": "distant", "direction": [0, 0, 1], "angle": 181}])", "/lights/0/angle", "181", "0..180",
     ""},
    {R"("lights": [{"kind": "rectangle", "corner": [0, 0, 0], "edges": [[1, 0, 0], [2, 0, 0]]}])", "/lights/0/edges",
     "[[1,0,0],[2,0,0]]", "span an area", ""},
    {R"("lights": [{"kind": "rectangle", "corner": [0, 0, 0], "edges": [[1, 0, 0]]}])", "/lights/0/edges", "[[1,0,0]]",
     "a list of 2", ""},
    {R"("lights": [{"kind": "sphere", "center": [0, 0, 0], "radius": 0}])", "/lights/0/radius", "0", "above 0", ""},
    {R"("lights": [{"kind": "sphere", "centre": [0, 0, 0], "radius": 1}])", "/lights/0",
     "the key 'centre' and no 'center'", "'center'", ""},
    {R"("surfaces": [{"mesh": "a.obj"}])", "/surfaces/0", "no key 'material'", "'material'", ""},
    {R"("surfaces": [{"mesh": 3, "material": {"kind": "lambert"}}])", "/surfaces/0/mesh", "3", "a text in quotes", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": "lambert"}])", "/surfaces/0/material", "\"lambert\"", "an object",
     ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "lambertian"}}])", "/surfaces/0/material/kind",
     "\"lambertian\"", "lambert, dielectric, conductor", "did you mean 'lambert'?"},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "lambert", "reflectance": 1.2}}])",
     "/surfaces/0/material/reflectance", "1.2", "0..1", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "lambert", "colour": 1}}])", "/surfaces/0/material",
     "'colour'", "kind, reflectance", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "lambert", "ior": 1}}])", "/surfaces/0/material", "'ior'",
     "kind, reflectance", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "dielectric", "ior": 0}}])", "/surfaces/0/material/ior",
     "0", "0.1..10", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "dielectric", "roughness": 2}}])",
     "/surfaces/0/material/roughness", "2", "0..1", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "dielectric", "absorption": [0, -1, 0]}}])",
     "/surfaces/0/material/absorption/1", "-1", "0..", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "dielectric", "tint": 2}}])", "/surfaces/0/material/tint",
     "2", "0..1", ""},
    {R"("surfaces": [{"mesh": "a.obj", "material": {"kind": "conductor", "k": 1}}])", "/surfaces/0/material",
     "no key 'eta'", "'eta'", ""},
    {R"("grains": {"assembly": {"spheres": []}})", "/grains", "no key 'types'", "'types'", ""},
    {R"("grains": {"types": {}, "assembly": {"spheres": []}})", "/grains/types", "{}", "at least one grain type", ""},
    {R"("grains": {"types": {)" + clay + "}}", "/grains", "no key 'assembly'", "'assembly'", ""},
    {R"("grains": {"types": {"a": {"shape": "cube", "material": {"kind": "lambert"}}}, "assembly": {"spheres": []}})",
     "/grains/types/a/shape", "\"cube\"", "\"sphere\", {\"mesh\": FILE} or a grain of the library: sugar, brown_sugar",
     ""},
    {R"("grains": {"types": {"a": {"shape": "brown_suger"}}, "assembly": {"spheres": []}})", "/grains/types/a/shape",
     "\"brown_suger\"", "white_sand", "did you mean 'brown_sugar'?"},
    {R"("grains": {"types": {"a": {"shape": "spere"}}, "assembly": {"spheres": []}})", "/grains/types/a/shape",
     "\"spere\"", "\"sphere\"", "did you mean 'sphere'?"},
    {R"("grains": {"types": {"a": {"shape": 3}}, "assembly": {"spheres": []}})", "/grains/types/a/shape", "3",
     "{\"library\": NAME}", ""},
    {R"("grains": {"types": {"a": {"shape": {"library": "suggar"}}}, "assembly": {"spheres": []}})",
     "/grains/types/a/shape/library", "\"suggar\"", "sugar", "did you mean 'sugar'?"},
    {R"("grains": {"types": {"a": {"shape": {"library": "sugar", "triangles": 10}}}, "assembly": {"spheres": []}})",
     "/grains/types/a/shape/triangles", "10", "20..", ""},
    {R"("grains": {"types": {"a": {"shape": {"library": "sugar", "sed": 1}}}, "assembly": {"spheres": []}})",
     "/grains/types/a/shape", "'sed'", "seed", "did you mean 'seed'?"},
    {R"("grains": {"types": {"a": {"shape": {"library": "sugar", "parameters": {"chip": 1}}}}, "assembly": {"spheres": []}})",
     "/grains/types/a/shape/parameters", "'chip'", "chips", "did you mean 'chips'?"},
    {R"("grains": {"types": {"a": {"shape": {"library": "sugar", "parameters": {"chips": -1}}}}, "assembly": {"spheres": []}})",
     "/grains/types/a/shape/parameters/chips", "-1", "0..30", ""},
    {R"("grains": {"unit": "inch", "types": {"a": {"shape": "sugar"}}, "assembly": {"spheres": []}})", "/grains/unit",
     "\"inch\"", "m, cm, mm, um", ""},
    {R"("grains": {"unit": 0, "types": {"a": {"shape": "sugar"}}, "assembly": {"spheres": []}})", "/grains/unit", "0",
     "above 0", ""},
    {R"("grains": {"unit": true, "types": {"a": {"shape": "sugar"}}, "assembly": {"spheres": []}})", "/grains/unit",
     "true", "metres per unit", ""},
    {R"("grains": {"types": {"a": {"shape": {"file": "x.obj"}, "material": {"kind": "lambert"}}}, "assembly": {"spheres": []}})",
     "/grains/types/a/shape", "no key 'mesh'", "'mesh'", ""},
    {R"("grains": {"types": {"a": {"shape": "sphere"}}, "assembly": {"spheres": []}})", "/grains/types/a",
     "no key 'material'", "'material'", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {}})", "/grains/assembly", "{}",
     "\"dump\", \"fill\" or \"spheres\"", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"fill": "a.off"}})", "/grains/assembly", "no key 'tile'",
     "'tile'", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"fill": "a.off", "tile": "t.vdb", "radius": 0}})",
     "/grains/assembly/radius", "0", "above 0", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"dump": "a", "spheres": []}})", "/grains/assembly",
     "'spheres'", "dump", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump"}})", "/grains/assembly", "a.dump", "the key 'types'",
     "\"types\": {\"1\": \"clay\"}"},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {}}})", "/grains/assembly/types", "{}", "at least one",
     ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"1": "cly"}}})", "/grains/assembly/types/1", "\"cly\"",
     "clay, stone", "did you mean 'clay'?"},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"one": "clay"}}})", "/grains/assembly/types",
     "the key 'one'", "a type number", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {" 1": "clay"}}})", "/grains/assembly/types",
     "the key ' 1'", "a type number", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"01": "clay"}}})", "/grains/assembly/types",
     "the key '01'", "a type number", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"99999999999": "clay"}}})", "/grains/assembly/types",
     "the key '99999999999'", "a type number", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"1": "clay"}, "radius": 0}})",
     "/grains/assembly/radius", "0", "above 0", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"1": "clay"}, "radius": {"1": -2}}})",
     "/grains/assembly/radius/1", "-2", "0", ""},
    {grains_of_two + R"("assembly": {"dump": "a.dump", "types": {"1": "clay"}, "radius": "big"}})",
     "/grains/assembly/radius", "\"big\"", "a number above 0, or an object", ""},
    {grains_of_two + R"("assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1}]}})", "/grains/assembly/spheres/0",
     "radius", "the key 'type'", ""},
    {grains_of_two + R"("assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1, "type": "ston"}]}})",
     "/grains/assembly/spheres/0/type", "\"ston\"", "clay, stone", "did you mean 'stone'?"},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": [{"center": [0, 0, 0], "radius": -1}]}})",
     "/grains/assembly/spheres/0/radius", "-1", "0", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1e39}]}})",
     "/grains/assembly/spheres/0/radius", "1e+39", "0..3.4", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": [{"centre": [0, 0, 0], "radius": 1}]}})",
     "/grains/assembly/spheres/0", "'centre'", "'center'", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": []}, "mixture": {"kind": "perlin"}})",
     "/grains/mixture", "no key 'types'", "'types'", ""},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": []}, "mixture": {"kind": "perlim"}})",
     "/grains/mixture/kind", "\"perlim\"", "perlin", "did you mean 'perlin'?"},
    {R"("grains": {"types": {)" + clay + R"(}, "assembly": {"spheres": []}, "mixture": "cly"})", "/grains/mixture",
     "\"cly\"", "clay", "did you mean 'clay'?"},
    {R"("medium": [{"mesh": "slab.off"}])", "/medium/0", "no key 'sigma_t'", "'sigma_t'", ""},
    {R"("medium": [{"sigma_t": 1}])", "/medium/0", "sigma_t", "either the key 'mesh'", "slab.off"},
    {R"("medium": [{"mesh": "slab.off", "vdb": "cloud.vdb"}])", "/medium/0", "cloud.vdb", "either the key 'mesh'", ""},
    {R"("medium": [{"mesh": "slab.off", "sigma_t": -1}])", "/medium/0/sigma_t", "-1", "0..", ""},
    {R"("medium": [{"mesh": "slab.off", "sigma_t": 1, "albedo": 1.5}])", "/medium/0/albedo", "1.5", "0..1", ""},
    {R"("medium": [{"mesh": "slab.off", "sigma_t": 1, "g": 1}])", "/medium/0/g", "1", "above -1 and below 1", ""},
    {R"("medium": [{"mesh": "slab.off", "sigma_t": 1, "density": "rho"}])", "/medium/0", "'density'", "", ""},
    {R"("medium": [{"vdb": "cloud.vdb", "interpolation": "cubic"}])", "/medium/0/interpolation", "cubic",
     "linear, nearest", ""},
    {R"("integrator": {"grain_depth": -1})", "/integrator/grain_depth", "-1", "0..", ""},
    {R"("integrator": {"grain_pixels": -1})", "/integrator/grain_pixels", "-1", "0..", ""},
    {R"("integrator": {"grain_flights": -1})", "/integrator/grain_flights", "-1", "0..", ""},
    {R"("integrator": {"least_shell": -1})", "/integrator/least_shell", "-1", "0..", ""},
    {R"("integrator": {"medium_form": "wlk"})", "/integrator/medium_form", "wlk", "plain, formula, walk, decay",
     "did you mean 'walk'?"},
    {R"("integrator": {"kind": "epd"})", "/integrator/kind", "\"epd\"", "auto, ept, ppt, vpt", "did you mean 'ept'?"},
    {R"("integrator": {"kind": "stff"})", "/integrator/kind", "\"stff\"", "auto, ept, ppt, vpt, stf",
     "did you mean 'stf'?"},
    {R"("integrator": {"shells": "on"})", "/integrator/shells", "\"on\"", "true or false", ""},
    {R"("integrator": {"shells": 1})", "/integrator/shells", "1", "true or false", ""},
    {R"("integrator": {"shels": true})", "/integrator", "'shels'", "shells", "did you mean 'shells'"},
    {R"("integrator": {"stf_form": "difusion"})", "/integrator/stf_form", "\"difusion\"",
     "full, cosine, hg, interpolated, diffusion", "did you mean 'diffusion'?"},
    {R"("integrator": {"stf_form": 2})", "/integrator/stf_form", "2", "", ""},
    {R"("integrator": {"stf_from": "full"})", "/integrator", "'stf_from'", "stf_form", ""},
    {R"("integrator": {"explicit_grains": -1})", "/integrator/explicit_grains", "-1", "0..", ""},
    {R"("integrator": {"accuracy": "best"})", "/integrator/accuracy", "\"best\"", "reference, high, standard, draft",
     ""},
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
        EXPECT_THAT(std::string(error->what()),
                    testing::AllOf(HasSubstr(error->place()), HasSubstr(error->found()), HasSubstr(error->expected())));
    }
}

TEST(SceneDescription, BrokenJsonIsToldByLineAndColumn)
{
    for (const auto& [text, place] :
         std::vector<std::pair<std::string, std::string>>{{"{\n  \"camera\": {\n    \"fov\" 40\n}}", "scene.json:3:12"},
                                                          {"", "scene.json:1:1"},
                                                          {"{\"a\": 1e999}", "scene.json"},
                                                          {"{\"a\": nan}", "scene.json:1:8"}}) {
        const auto error = input_error_of([&] { read(text); });
        ASSERT_TRUE(error) << text;
        EXPECT_THAT(error->place(), HasSubstr(place)) << text;
    }
}

} // namespace
} // namespace scree
