// `scree grains gsdf` as a user sees it: the built program, its exit codes, messages, files and cache.

#include "tests/builders/scene_files.h"
#include "tests/builders/scree_process.h"
#include "tests/builders/shapes.h"
#include "tests/render/app/cached_command.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace scree {
namespace {

using namespace test;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class GsdfCommand : public CachedCommand {
protected:
    static ProgramRun gsdf(std::vector<std::string> arguments, const std::string& error = "0.2")
    {
        arguments.insert(arguments.begin(), {"grains", "gsdf", "--error", error});
        return run_scree(arguments);
    }
    static json gsdf_json(std::vector<std::string> arguments, const std::string& error = "0.2")
    {
        arguments.insert(arguments.end(), {"--json", "-"});
        const ProgramRun run = gsdf(arguments, error);
        EXPECT_EQ(run.status, 0) << run.err;
        return json::parse(run.out);
    }
    /// Expects status 2, all these texts in the message, and no files.
    void expect_refused(const std::vector<std::string>& arguments, const std::vector<std::string>& said)
    {
        const ProgramRun run = gsdf(arguments);
        EXPECT_EQ(run.status, 2) << testing::PrintToString(arguments);
        for (const std::string& text : said) EXPECT_THAT(run.err, HasSubstr(text));
        EXPECT_EQ(run.out, "");
        EXPECT_TRUE(stored().empty());
    }
};

TEST_F(GsdfCommand, TracesOnceAndThenFindsIt)
{
    const ProgramRun first = gsdf({"sphere"});
    EXPECT_EQ(first.status, 0) << first.err;
    EXPECT_THAT(first.err, HasSubstr("sphere tracing grains"));
    ASSERT_EQ(stored().size(), 1u);
    const auto lines = split_lines(first.out);
    ASSERT_EQ(lines.size(), 2u);
    for (const char* name :
         {"grain", "seconds", "paths", "error %", "asked", "alpha0", "cosine", "records", "lost", "file"})
        EXPECT_THAT(lines[0], HasSubstr(name));
    EXPECT_THAT(lines[1], AllOf(HasSubstr("sphere"), HasSubstr("traced"), HasSubstr(stored()[0].string())));

    const auto written = std::filesystem::last_write_time(stored()[0]);
    const ProgramRun second = gsdf({"sphere", "-q"});
    EXPECT_EQ(second.status, 0);
    EXPECT_EQ(second.err, "");
    EXPECT_THAT(split_lines(second.out)[1], AllOf(HasSubstr("cache"), Not(HasSubstr("traced"))));
    EXPECT_EQ(std::filesystem::last_write_time(stored()[0]), written);

    const ProgramRun forced = gsdf({"sphere", "--force"});
    EXPECT_THAT(forced.out, HasSubstr("traced"));
    ASSERT_EQ(stored().size(), 1u);
    EXPECT_GT(std::filesystem::last_write_time(stored()[0]), written);
}

// A table belongs to the error asked for, so that pictures do not depend on what else was traced.
TEST_F(GsdfCommand, TracesAgainForAnotherError)
{
    EXPECT_EQ(gsdf_json({"sphere", "--material", "lambert"}, "0.2")[0].at("traced"), true);
    const json again = gsdf_json({"sphere", "--material", "lambert"}, "0.2")[0];
    EXPECT_EQ(again.at("traced"), false);
    const double had = again.at("error");
    const json better = gsdf_json({"sphere", "--material", "lambert"}, std::to_string(0.7 * had))[0];
    EXPECT_EQ(better.at("traced"), true);
    EXPECT_LE(better.at("error").get<double>(), 0.7 * had);
}

TEST_F(GsdfCommand, TellsTheTruthInNumbers)
{
    // Mean cosines of spheres: by geometric optics, and -4/9 for the Lambert sphere.
    const std::vector<std::pair<std::vector<std::string>, double>> cases{
        {{"sphere"}, 0.65009},
        {{"sphere", "--ior", "1.31"}, 0.78166},
        {{"sphere", "--material", "lambert"}, -4.0 / 9},
        {{"diffuse_sphere"}, -4.0 / 9}};
    for (const auto& [arguments, truth] : cases) {
        const json list = gsdf_json(arguments);
        ASSERT_EQ(list.size(), 1u);
        const json& grain = list[0];
        EXPECT_EQ(grain.at("name"), arguments[0]);
        EXPECT_EQ(grain.at("error_wanted"), 0.2);
        EXPECT_LE(grain.at("error").get<double>(), 0.2);
        EXPECT_GE(grain.at("paths").get<uint64_t>(), uint64_t{1} << 19);
        EXPECT_EQ(grain.at("lost_paths"), 0);
        EXPECT_EQ(grain.at("mean_alpha0"), 0.0);
        EXPECT_GT(grain.at("records").get<uint64_t>(), 0u);
        EXPECT_GT(grain.at("bytes").get<uint64_t>(), 0u);
        EXPECT_TRUE(std::filesystem::exists(grain.at("file").get<std::string>()));
        const double error = grain.at("mean_cosine_error");
        EXPECT_NEAR(grain.at("mean_cosine").get<double>(), truth, 4 * error + 5e-6) << arguments.back();
        EXPECT_LT(error, 1e-3);

        EXPECT_EQ(grain.at("alpha0").at("value").size(), grain.at("alpha0").at("q").size());
        for (const double alpha0 : grain.at("alpha0").at("value")) EXPECT_EQ(alpha0, 0);
        const auto theta = grain.at("phase_function").at("theta_degrees").get<std::vector<double>>();
        const auto density = grain.at("phase_function").at("per_steradian").get<std::vector<double>>();
        ASSERT_EQ(theta.size(), density.size());
        double sum = 0, cosine = 0;
        for (size_t i = 0; i < theta.size(); ++i) {
            const double half = 90.0 / static_cast<double>(theta.size()), radian = std::numbers::pi / 180;
            const double from = std::cos((theta[i] - half) * radian), to = std::cos((theta[i] + half) * radian);
            sum += 2 * std::numbers::pi * density[i] * (from - to);
            cosine += std::numbers::pi * density[i] * (from * from - to * to);
        }
        EXPECT_NEAR(sum, 1, 1e-5);
        EXPECT_NEAR(cosine, truth, 4 * error + 1e-3); // uniform within a bin, which is 2.8 degrees wide
    }
}

TEST_F(GsdfCommand, MaterialsAreThoseAskedFor)
{
    EXPECT_EQ(gsdf_json({"sphere", "--ior", "1.31", "--roughness", "0.5"})[0].at("material"),
              (json{{"kind", "dielectric"}, {"ior", 1.31}, {"roughness", 0.5}}));
    EXPECT_EQ(gsdf_json({"diffuse_sphere"})[0].at("material"), (json{{"kind", "lambert"}}));
    const json metal =
        gsdf_json({"sphere", "--material", "conductor", "--eta", "0.5,1,2", "--k", "3"})[0].at("material");
    EXPECT_EQ(metal, (json{{"kind", "conductor"}, {"eta", {0.5, 1, 2}}, {"k", {3, 3, 3}}, {"roughness", 0}}));
    EXPECT_EQ(stored().size(), 3u); // each of its own
}

TEST_F(GsdfCommand, ReadsMeshesAndWritesJsonFiles)
{
    const std::string mesh = folder_.write("box.obj", obj_text(cube()));
    const ProgramRun run = gsdf({mesh, "diffuse_sphere", "--json", path("out.json")});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(split_lines(run.out).size(), 3u);
    const json list = json::parse(read_bytes(path("out.json")));
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].at("name"), mesh);
    // The mean alpha0 of a convex body is 1 - its mean shadow (a quarter of its surface) over pi: here a cube of edge
    // 2 / sqrt(3).
    const double truth = 1 - 2 / std::numbers::pi, paths = list[0].at("paths");
    EXPECT_NEAR(list[0].at("mean_alpha0").get<double>(), truth, 4 * std::sqrt(truth * (1 - truth) / paths));
    EXPECT_EQ(gsdf_json({mesh})[0].at("traced"), false);
}

TEST_F(GsdfCommand, TheRendererFindsWhatItMade)
{
    const std::string mesh = folder_.write("box.obj", obj_text(cube()));
    const std::string scene = folder_.write(
        "scene.json",
        R"({"camera": {"kind": "orthographic", "origin": [0, 0, 9], "target": [0, 0, 0], "up": [0, 1, 0], "width": 4},
        "film": {"size": [8, 8]}, "lights": [{"kind": "constant", "radiance": 1}],
        "grains": {"types": {"box": {"shape": {"mesh": "box.obj"}, "material": {"kind": "dielectric", "ior": 1.4, "roughness": 0.3}},
                             "flour": {"shape": "flour"}, "other": {"shape": "sphere", "material": {"kind": "lambert", "reflectance": 0.2}}},
                   "assembly": {"spheres": [{"center": [0, 0, 0], "radius": 1, "type": "box"}, {"center": [5, 0, 0], "radius": 1, "type": "flour"},
                               {"center": [9, 0, 0], "radius": 1, "type": "other"}]}},
        "integrator": {"kind": "ppt", "accuracy": "draft"}})");
    const auto plan = [&] { return run_scree({"render", scene, "--plan"}).out; };
    const auto count = [](const std::string& text, const std::string& word) {
        size_t n = 0;
        for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
        return n;
    };
    EXPECT_EQ(count(plan(), "not in the cache"), 3u) << plan();
    EXPECT_EQ(gsdf({mesh, "--ior", "1.4", "--roughness", "0.3"}, "0.08").status, 0);
    EXPECT_EQ(gsdf({"flour"}, "0.08").status, 0);
    EXPECT_EQ(gsdf({"sphere", "--material", "lambert"}, "0.08").status, 0);
    EXPECT_EQ(count(plan(), "from the cache"), 3u) << plan();
}

TEST_F(GsdfCommand, MakesADamagedFileAgain)
{
    EXPECT_EQ(gsdf({"sphere"}).status, 0);
    ASSERT_EQ(stored().size(), 1u);
    const std::string good = read_bytes(stored()[0]);
    std::string bad = good;
    bad[bad.size() / 2] ^= 1;
    for (const std::string& bytes : {bad, good.substr(0, good.size() - 1), std::string(), std::string("nonsense")}) {
        std::ofstream(stored()[0], std::ios::binary) << bytes;
        const ProgramRun run = gsdf({"sphere"});
        EXPECT_EQ(run.status, 0);
        EXPECT_THAT(run.err, AllOf(HasSubstr(stored()[0].string()), HasSubstr("made again")));
        EXPECT_THAT(run.out, HasSubstr("traced"));
        EXPECT_EQ(read_bytes(stored()[0]).size(), good.size());
        EXPECT_THAT(gsdf({"sphere"}).out, Not(HasSubstr("traced")));
    }
}

TEST_F(GsdfCommand, DoesWithoutACache)
{
    setenv("SCREE_CACHE", folder_.write("a_file", "").c_str(), 1);
    const ProgramRun run = gsdf({"diffuse_sphere"});
    EXPECT_EQ(run.status, 0);
    EXPECT_THAT(run.err, HasSubstr("not kept"));
    EXPECT_THAT(run.out, HasSubstr("not kept"));
}

TEST_F(GsdfCommand, RefusesWhatItCannotDo)
{
    const std::string box = folder_.write("box.obj", obj_text(cube()));
    const std::string open = folder_.write("open.obj", obj_text(ground(1, 0)));
    expect_refused({"sugr"}, {"'sugr'", "did you mean 'sugar'?"});
    expect_refused({"shpere"}, {"did you mean 'sphere'?"});
    expect_refused({}, {"what"});
    expect_refused({path("none.ply")}, {"none.ply"});
    expect_refused({folder_.write("empty.ply", "")}, {"empty.ply"});
    expect_refused({"sphere", path("none.ply")}, {"none.ply"}); // before anything is traced
    expect_refused({"sphere", "--material", "glas"}, {"--material", "'glas'", "dielectric"});
    expect_refused({"flour", "--ior", "1.3"}, {"--ior", "lambert", "a dielectric"});
    expect_refused({"flour", "--roughness", "0.3"}, {"--roughness"});
    expect_refused({"sphere", "--eta", "1"}, {"--eta", "a conductor"});
    expect_refused({"sphere", "--material", "conductor", "--k", "1,2"}, {"--k", "'1,2'"});
    expect_refused({"sphere", "--material", "conductor", "--eta", "1,x,2"}, {"--eta", "'1,x,2'"});
    for (const char* ior : {"0", "nan", "11"}) expect_refused({"sphere", "--ior", ior}, {"--ior"});
    expect_refused({"sphere", "--roughness", "1.5"}, {"--roughness"});
    expect_refused({box, "--triangles", "100"}, {"--triangles", "no grain of the library"});
    expect_refused({"sphere", "--seed", "1"}, {"--seed", "no grain of the library"});
    expect_refused({"sphere", "--threads", "0"}, {"--threads"});
    expect_refused({"sphere", "sugar", "--figure", path("a.png")}, {"--figure", "2 grains"});
    expect_refused({"sphere", "--figure", path("a.docx")}, {"a.docx"});
    expect_refused({"sphere", "--figure", path("none/a.png")}, {"none"});
    expect_refused({"sphere", "--json", path("none/a.json")}, {"none"});
    expect_refused({"sphere", "--size", "10x10"}, {"--size", "'10x10'"});
    expect_refused({"sphere", "--size", "big"}, {"--size", "'big'"});
    for (const char* error : {"0", "-1", "nan", "x"}) EXPECT_EQ(gsdf({"sphere"}, error).status, 2) << error;
    EXPECT_TRUE(stored().empty());
    const ProgramRun run = gsdf({open});
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, AllOf(HasSubstr("open.obj"), HasSubstr("a closed mesh")));
    EXPECT_EQ(gsdf({open, "--material", "lambert"}).status, 0);
}

TEST_F(GsdfCommand, InterruptedLeavesNothing)
{
    const ProgramRun run = run_scree({"grains", "gsdf", "brown_sugar", "--error", "0.001", "--json", path("out.json")},
                                     "tracing grains", 0.2);
    EXPECT_EQ(run.status, 130);
    EXPECT_TRUE(stored().empty());
    EXPECT_FALSE(std::filesystem::exists(path("out.json")));
}

TEST_F(GsdfCommand, DrawsTheErrorMaps)
{
    const ProgramRun run = gsdf({"diffuse_sphere", "--figure", path("maps.png"), "--size", "800x520", "--figure-paths",
                                 "200000", "--json", path("out.json")});
    EXPECT_EQ(run.status, 0) << run.err;
    for (const char* text :
         {"mean error %", "p(omega_i | beta_o)", "ours", "factored", "Henyey-Greenstein", "isotropic", "noise floor"})
        EXPECT_THAT(run.out, HasSubstr(text));
    const std::string png = read_bytes(path("maps.png"));
    ASSERT_GT(png.size(), 1000u);
    EXPECT_EQ(png.substr(1, 3), "PNG");
    const auto size_at = [&](size_t i) {
        return 256 * static_cast<unsigned char>(png[i + 2]) + static_cast<unsigned char>(png[i + 3]);
    };
    EXPECT_EQ(size_at(16), 800);
    EXPECT_EQ(size_at(20), 520);

    const json list = json::parse(read_bytes(path("out.json")));
    const json& figure = list[0].at("figure");
    EXPECT_GE(figure.at("paths").get<uint64_t>(), 200000u);
    const json &forms = figure.at("mean_error"), &noise = figure.at("noise_floor");
    for (const char* kind : {"direction", "full"}) {
        for (const char* form : {"gsdf", "factored", "hg", "isotropic"})
            EXPECT_GT(forms.at(form).at(kind).get<double>(), 0) << form;
        // The GSDF's own error is at most 20 %; the isotropic form, which lacks its directions, has a larger error.
        EXPECT_LT(forms.at("gsdf").at(kind).get<double>(), std::hypot(0.2, noise.at(kind).get<double>()));
        EXPECT_GT(forms.at("isotropic").at(kind).get<double>(), 1);
    }
    EXPECT_EQ(forms.at("hg").at("g").size(), 8u);
}

} // namespace
} // namespace scree
