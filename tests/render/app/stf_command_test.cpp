// `scree grains stf` as a user sees it: the built program, its exit codes, messages, files and cache.

#include "tests/builders/scree_process.h"
#include "tests/render/app/cached_command.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace scree {
namespace {

using namespace test;
using nlohmann::json;
using testing::HasSubstr;

class StfCommand : public CachedCommand {
protected:
    static ProgramRun stf(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), {"grains", "stf", "--accuracy", "draft", "-q"});
        return run_scree(arguments);
    }
    static json stf_json(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.end(), {"--json", "-"});
        const ProgramRun run = stf(arguments);
        EXPECT_EQ(run.status, 0) << run.err;
        return json::parse(run.out);
    }
};

TEST_F(StfCommand, PartsOfLightSumToAllOfIt)
{
    const json report = stf_json({"--g", "0.5", "--g", "-0.3", "--radius", "4", "--albedo", "0.9"});
    ASSERT_EQ(report.size(), 2u);
    for (const json& medium : report) {
        ASSERT_EQ(medium["shells"].size(), 5u); // 1, sqrt 2, 2, 2 sqrt 2, 4
        double last = 1;
        for (const json& shell : medium["shells"]) {
            const double unscattered = shell["unscattered"], single = shell["single"], multiple = shell["multiple"],
                         radius = shell["radius"];
            EXPECT_NEAR(unscattered, std::exp(-radius), 1e-6);
            EXPECT_NEAR(unscattered + single + multiple, 1, 1e-5);
            EXPECT_LT(unscattered, last);
            last = unscattered;
            const json& dim = shell["at_albedo"];
            EXPECT_NEAR(dim["single"].get<double>(), 0.9 * single, 1e-4);
            EXPECT_LT(dim["multiple"].get<double>(), 0.81 * multiple + 1e-6); // two scatterings at least
            EXPECT_NEAR(unscattered + dim["single"].get<double>() + dim["multiple"].get<double>() +
                            dim["absorbed"].get<double>(),
                        1, 1e-5);
            // A mean that is constant along walks, see calibrate() in stf_builder.cpp.
            const double g = medium["phase_function"]["mean_cosine"];
            EXPECT_NEAR((1 - g) * radius * shell["mean_cosine_theta_t"].get<double>() +
                            shell["mean_cosine_in_out"].get<double>(),
                        1, 1e-3);
        }
    }
}

TEST_F(StfCommand, TakesGrainsFromTheCacheAndSaysTheSameAgain)
{
    const json first = stf_json({"sphere", "--radius", "2"}), again = stf_json({"sphere", "--radius", "2"});
    EXPECT_EQ(first[0]["phase_function"]["kind"], "table");
    EXPECT_TRUE(first[0]["shells"][0]["made"]);
    EXPECT_FALSE(again[0]["shells"][0]["made"]);
    EXPECT_EQ(first[0]["shells"][2]["single"], again[0]["shells"][2]["single"]);
    EXPECT_FALSE(stored().empty());
}

TEST_F(StfCommand, PrintsATableAndDrawsAFigure)
{
    const ProgramRun run =
        stf({"--g", "0.8", "--radius", "4", "--figure", path("shells.png"), "--figure-walks", "20000"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("unscattered"));
    EXPECT_THAT(run.out, HasSubstr("g=0.8"));
    EXPECT_GT(std::filesystem::file_size(path("shells.png")), 10000u);
}

TEST_F(StfCommand, RefusesWhatCannotBe)
{
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{}, "found no phase function"},
        {{"--g", "2"}, "--g: found 2"},
        {{"shugar"}, "'shugar'"},
        {{"--g", "0", "--radius", "0.5"}, "--radius: found 0.5"},
        {{"--g", "0", "--radius", "5000"}, "--radius: found 5000"},
        {{"--g", "0", "--albedo", "2"}, "--albedo: found 2"},
        {{"--g", "0", "--figure", path("shells.txt")}, "'.txt'"},
        {{"--g", "0", "--figure", path("no/shells.png")}, "expected a folder that exists"}};
    for (const auto& [arguments, said] : cases) {
        const ProgramRun run = stf(arguments);
        EXPECT_EQ(run.status, 2) << testing::PrintToString(arguments);
        EXPECT_THAT(run.err, HasSubstr(said));
        EXPECT_EQ(run.out, "");
        EXPECT_TRUE(stored().empty());
    }
}

} // namespace
} // namespace scree
