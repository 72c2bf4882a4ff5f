#include "mixtures/pattern_statistics.h"
#include "render/app/mixture_command.h"
#include "tests/builders/test_files.h"
#include "tests/mixtures/mixture_builders.h"

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace scree {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string pour = std::string(SCREE_EXAMPLES) + "/pour/pour.0009.dump.gz";

class MixtureCommand : public testing::Test {
protected:
    std::string run(std::vector<std::string> words)
    {
        CLI::App app;
        add_mixture_command(app);
        words.insert(words.begin(), "mixture");
        std::ranges::reverse(words);
        testing::internal::CaptureStdout();
        try {
            app.parse(words);
        } catch (...) {
            testing::internal::GetCapturedStdout();
            throw;
        }
        std::fflush(stdout);
        return testing::internal::GetCapturedStdout();
    }
    json made(std::vector<std::string> words)
    {
        words.insert(words.begin(), "new");
        return json::parse(run(words));
    }
    std::string path(const std::string& name) { return folder_.path(name).string(); }

    test::TemporaryFolder folder_;
};

TEST_F(MixtureCommand, NewWritesEveryKind)
{
    EXPECT_EQ(made({"single", "glass"}), json::parse(R"({"kind": "single", "type": "glass"})"));
    EXPECT_EQ(made({"random", "a=3", "b=1", "--by", "volume", "--seed", "7"}),
              json::parse(R"({"kind": "random", "types": ["a", "b"], "weights": [3, 1], "by": "volume", "seed": 7})"));
    EXPECT_EQ(
        made({"perlin", "a", "b", "--scale", "3", "--fraction", "0.25", "--octaves", "3"}),
        json::parse(R"({"kind": "perlin", "types": ["a", "b"], "scale": 3, "octaves": 3, "fraction": [0.25, 0.75]})"));
    EXPECT_EQ(made({"checkerboard", "a", "b", "--cell", "1,2,3", "--offset", "-1,0,0"}),
              json::parse(R"({"kind": "checkerboard", "types": ["a", "b"], "cell": [1, 2, 3], "offset": [-1, 0, 0]})"));
    EXPECT_EQ(
        made({"layers", "a=1", "b=2", "--direction", "0,1,0", "--jitter", "0.5", "--jitter-scale", "2", "--repeat",
              "false"}),
        json::parse(
            R"({"kind": "layers", "types": ["a", "b"], "thicknesses": [1, 2], "direction": [0, 1, 0], "repeat": false,
                              "jitter": {"amplitude": 0.5, "scale": 2}})"));
    EXPECT_EQ(made({"radius", "a", "b", "--thresholds", "0.4"}),
              json::parse(R"({"kind": "radius", "types": ["a", "b"], "thresholds": [0.4]})"));
    EXPECT_EQ(made({"explicit", "1=a", "2=b"}), json::parse(R"({"kind": "explicit", "types": {"1": "a", "2": "b"}})"));
    run({"new", "checkerboard", "core", "rim", "--cell", "2", "-o", path("by.json")});
    const json blend = made({"blend", "core=glass", "rim=sugar", "--by", path("by.json")});
    EXPECT_EQ(blend["by"]["kind"], "checkerboard");
    EXPECT_EQ(blend["mixtures"]["core"], json::parse(R"({"kind": "single", "type": "glass"})"));
    const json grid = made({"grid", "a=" + path("c.vdb") + ":density", "--rest", "b"});
    EXPECT_EQ(grid["fields"][0]["grid"], "density");
    EXPECT_EQ(grid["rest"], "b");
}

TEST_F(MixtureCommand, NewRefusesWhatTheReaderWould)
{
    EXPECT_TRUE(test::input_error_of([&] { run({"new", "perlin", "a", "b", "-o", path("m.json")}); }));
    EXPECT_TRUE(test::input_error_of([&] { run({"new", "random", "a=1", "b", "-o", path("m.json")}); }));
    EXPECT_TRUE(test::input_error_of([&] { run({"new", "random", "a=x", "-o", path("m.json")}); }));
    EXPECT_TRUE(test::input_error_of([&] { run({"new", "checkerboard", "a=1", "--cell", "1"}); }));
    EXPECT_FALSE(std::filesystem::exists(path("m.json")));
    EXPECT_THROW(run({"new", "radnom", "a"}), CLI::ParseError);
}

TEST_F(MixtureCommand, ShowTellsFractions)
{
    run({"new", "random", "glass=3", "sugar=1", "-o", path("m.json")});
    const std::string text = run({"show", path("m.json")});
    EXPECT_THAT(text, HasSubstr("75 % glass, 25 % sugar"));
    EXPECT_THAT(text, HasSubstr("25.000 %"));
    EXPECT_THAT(run({"show", std::string(SCREE_EXAMPLES) + "/pour/scene.json"}), HasSubstr("depend on the spheres"));
}

TEST_F(MixtureCommand, PreviewDrawsAndMeasures)
{
    run({"new", "checkerboard", "glass", "sugar", "--cell", "6", "-o", path("m.json")});
    EXPECT_THAT(run({"preview", path("m.json"), pour, "-o", path("m.png")}), HasSubstr("20000 spheres"));
    EXPECT_EQ(test::read_bytes(path("m.png")).substr(1, 3), "PNG");
    const std::string text = run({"preview", path("m.json"), pour, "--stat"});
    EXPECT_THAT(text, HasSubstr("glass"));
    EXPECT_THAT(text, HasSubstr("correlation length"));
    EXPECT_TRUE(test::input_error_of([&] { run({"preview", path("m.json")}); }));
    EXPECT_TRUE(test::input_error_of([&] { run({"preview", path("m.json"), pour, "--frame", "5"}); }));
    EXPECT_TRUE(test::input_error_of([&] { run({"preview", path("m.json"), pour, "-o", path("m.zzz")}); }));
    // A scene provides its dump and its names.
    EXPECT_THAT(run({"preview", std::string(SCREE_EXAMPLES) + "/pour/scene.json", "--stat"}), HasSubstr("terracotta"));
}

TEST_F(MixtureCommand, CheckFindsWhatDoesNotFit)
{
    const std::string scene =
        folder_.write("scene.json", R"({"grains": {"types": {"glass": {}, "sugar": {}, "salt": {}}}})");
    run({"new", "random", "glas=1", "sugar=1", "-o", path("m.json")});
    const auto error = test::input_error_of([&] { run({"check", path("m.json"), scene}); });
    ASSERT_TRUE(error);
    EXPECT_THAT(error->what(), HasSubstr("'glas', did you mean 'glass'?"));
    run({"new", "random", "glass=1", "sugar=0", "-o", path("m.json")});
    EXPECT_THAT(run({"check", path("m.json"), scene}), HasSubstr("never chosen: salt, sugar"));
}

TEST(PatternStatistics, IntervalsHoldTheirLevel)
{
    // Independent draws: 95 of 100 intervals must contain the true fraction.
    int number = 0, volume = 0;
    for (uint64_t seed = 0; seed < 200; ++seed) {
        const ParticleFrame frame = test::random_spheres(4000, 30, 0.3, Imath::V3d(0), seed);
        test::Numbers numbers(seed);
        std::vector<uint32_t> types(frame.size());
        for (uint32_t& type : types) type = numbers.unit() < 0.3 ? 0 : 1;
        const PatternStatistics s = pattern_statistics(frame, types, 2, 0);
        number += s.types[0].by_number.low <= 0.3 && s.types[0].by_number.high >= 0.3;
        volume += s.types[0].by_volume.low <= 0.3 && s.types[0].by_volume.high >= 0.3;
        EXPECT_NEAR(s.types[0].by_number.value, double(s.types[0].count) / 4000, 1e-12);
    }
    const double error = 4 * std::sqrt(200 * 0.05 * 0.95);
    EXPECT_NEAR(number, 190, error);
    EXPECT_NEAR(volume, 190, error);
}

TEST(PatternStatistics, CorrelationLengthOfLayersIsAsReckoned)
{
    // Alternating layers of thickness t: over a distance d at direction cosine c the correlation is a triangle wave of
    // |c| d, with 1 - 2 |c| d / t up to t. The mean over directions is 1 - d / t while d < t, so it falls to 1/e at
    // d = t (1 - 1/e).
    const ParticleFrame frame = test::random_spheres(200000, 60);
    const double t = 12;
    const auto mixture = test::mixture_of(R"({"kind": "layers", "types": ["a", "b"], "thicknesses": 12})", &frame);
    const PatternStatistics s = pattern_statistics(frame, test::types_of(*mixture, frame), 2);
    EXPECT_NEAR(s.correlation_length, t * (1 - std::exp(-1.0)), 0.05 * t);
    const auto noise = test::mixture_of(R"({"kind": "random", "types": ["a", "b"]})", &frame);
    EXPECT_EQ(pattern_statistics(frame, test::types_of(*noise, frame), 2).correlation_length, 0);
}

} // namespace
} // namespace scree
