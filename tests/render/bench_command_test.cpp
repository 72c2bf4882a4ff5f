// scree bench from end to end on a scene of some grains.

#include "packing/report/svg_plot.h"
#include "render/bench/bench_command.h"
#include "render/bench/bench_page.h"
#include "render/bench/bench_words.h"
#include "render/bench/suite_report.h"
#include "tests/render/scene_files.h"

#include <CLI/CLI.hpp>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace scree {
namespace {

using namespace test;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Throws where it is not well-formed.
void check_xml(const std::string& text)
{
    std::istringstream stream(text);
    boost::property_tree::ptree tree;
    boost::property_tree::read_xml(stream, tree);
}

class BenchCommand : public testing::Test {
protected:
    BenchCommand() : scene_(standard_scene().write(folder_)) {}

    std::string path(const std::string& name) const { return folder_.path(name).string(); }
    /// What the command prints; its complaint is in wrong_.
    std::string run(std::vector<std::string> arguments)
    {
        arguments.insert(arguments.begin(), {"bench"});
        arguments.insert(arguments.end(), {"-q", "-t", "1"});
        std::ranges::reverse(arguments); // as CLI11 wants them
        CLI::App app;
        add_bench_command(app);
        wrong_.clear();
        testing::internal::CaptureStdout();
        try {
            app.parse(arguments);
        } catch (const std::exception& error) {
            wrong_ = error.what();
        }
        return testing::internal::GetCapturedStdout();
    }
    std::vector<std::string> quick(const std::string& folder) const
    {
        return {scene_, "-o", path(folder), "--integrators", "auto,ept", "--size", "24x18", "--time", "0.2", "--reference-time", "0.2"};
    }

    TemporaryFolder folder_;
    std::string scene_, wrong_;
};

TEST_F(BenchCommand, WritesATableNumbersAndAPage)
{
    const std::string text = run(quick("out"));
    EXPECT_EQ(wrong_, "");
    EXPECT_THAT(text, HasSubstr("ept"));
    EXPECT_THAT(text, HasSubstr("unit var."));
    const json numbers = json::parse(read_bytes(folder_.path("out/bench.json")));
    ASSERT_EQ(numbers["methods"].size(), 2u);
    for (const json& method : numbers["methods"]) {
        EXPECT_GT(method["spp"].get<int>(), 4);
        EXPECT_GT(method["noise"]["value"].get<double>(), 0);
        EXPECT_GT(method["segments_per_processor_second"].get<double>(), 0);
        EXPECT_FALSE(method["bias_measured"].get<bool>());
        EXPECT_GE(method["convergence"].size(), 3u);
        EXPECT_LT(method["convergence"].back()["squared_error"]["value"].get<double>(), method["convergence"].front()["squared_error"]["value"].get<double>());
    }
    const std::string page = read_bytes(folder_.path("out/index.html"));
    check_xml(page.substr(page.find("<html")));
    EXPECT_THAT(page, HasSubstr("data:image/png;base64,iVBOR"));
    EXPECT_THAT(page, HasSubstr("<svg"));
    EXPECT_THAT(page, Not(HasSubstr("<script")));
    EXPECT_TRUE(std::filesystem::exists(folder_.path("out/reference.exr")));
}

TEST_F(BenchCommand, GoesOnWithItsReference)
{
    run(quick("out"));
    const auto reference = [&] { return json::parse(read_bytes(folder_.path("out/bench.json")))["reference"]; };
    const json first = reference();
    run(quick("out"));
    EXPECT_EQ(reference()["spp"], first["spp"]); // as much was asked for as there is
    std::vector<std::string> longer = quick("out");
    longer.back() = "0.8";
    run(longer);
    EXPECT_EQ(wrong_, "");
    EXPECT_GT(reference()["spp"].get<int>(), 2 * first["spp"].get<int>());
    EXPECT_LT(reference()["noise"]["value"].get<double>(), first["noise"]["value"].get<double>());
    std::vector<std::string> other = quick("out");
    other.insert(other.end(), {"--seed", "3"});
    run(other);
    EXPECT_LT(reference()["spp"].get<int>(), 2 * first["spp"].get<int>()); // another seed: from the start
}

TEST_F(BenchCommand, TakesAPictureAsReference)
{
    run(quick("out"));
    std::vector<std::string> arguments{scene_, "-o", path("again"), "--integrators", "ept", "--size", "24x18", "--time", "0.2", "--reference", path("out/reference.exr")};
    run(arguments);
    EXPECT_EQ(wrong_, "");
    const json numbers = json::parse(read_bytes(folder_.path("again/bench.json")));
    EXPECT_TRUE(numbers["reference"]["noise_known"].get<bool>());
    arguments[6] = "20x18";
    run(arguments);
    EXPECT_THAT(wrong_, HasSubstr("24x18"));
}

TEST_F(BenchCommand, SharesNoSampleWithAPictureOfTheSameSeed)
{
    render_picture(scene_, [](RenderJob& job) {
        job.size = {24, 18};
        job.spp = 64;
        job.aov = {Aov::variance};
        job.integrator = IntegratorKind::ept;
    });
    run({scene_, "-o", path("out"), "--integrators", "ept", "--size", "24x18", "--time", "0.5", "--reference", path("out.exr")});
    EXPECT_EQ(wrong_, "");
    const json bias = json::parse(read_bytes(folder_.path("out/bench.json")))["methods"][0]["squared_bias"];
    EXPECT_LT(std::abs(bias["value"].get<double>()), 4 * bias["standard_error"].get<double>());
}

TEST_F(BenchCommand, ComplainsClearly)
{
    const auto complaint = [&](const std::vector<std::string>& arguments) {
        run(arguments);
        return wrong_;
    };
    EXPECT_THAT(complaint({}), HasSubstr("a scene file, or --suite"));
    EXPECT_THAT(complaint({scene_}), HasSubstr("--output"));
    EXPECT_THAT(complaint({scene_, "-o", path("x"), "--integrators", "ept,pppt"}), HasSubstr("did you mean 'ppt'"));
    EXPECT_THAT(complaint({scene_, "-o", path("x"), "--integrators", "ept,ept"}), HasSubstr("twice"));
    EXPECT_THAT(complaint({scene_, "-o", path("x"), "--size", "12"}), HasSubstr("WIDTHxHEIGHT"));
    EXPECT_THAT(complaint({scene_, "-o", path("x"), "--seeds", "1"}), HasSubstr("--seeds"));
    EXPECT_THAT(complaint({scene_, "-o", path("x"), "--frame", "99"}), HasSubstr("--frame"));
    EXPECT_THAT(complaint({"--suite", path("none.json"), "-o", path("x")}), HasSubstr("no such file"));
    EXPECT_THAT(complaint({"--suite", "--size", "8x8"}), HasSubstr("excludes"));
}

TEST_F(BenchCommand, RunsASuiteAndPutsItIntoAText)
{
    std::ofstream(folder_.path("suite.json")) << R"({"scenes": [{"name": "few", "scene": ")" << std::filesystem::path(scene_).filename().string()
                                              << R"(", "size": [16, 12], "integrators": ["ept"], "time": 0.2, "reference_time": 0.2}]})";
    std::ofstream(folder_.path("text.md")) << "before\n<!-- scree bench -->\nold\n<!-- /scree bench -->\nafter\n";
    const std::string text = run({"--suite", path("suite.json"), "-o", path("out"), "--readme", path("text.md"), "--suite-scale", "0.5"});
    EXPECT_EQ(wrong_, "");
    EXPECT_THAT(text, HasSubstr("few"));
    const std::string readme = read_bytes(folder_.path("text.md"));
    EXPECT_THAT(readme, HasSubstr("before\n<!-- scree bench -->\n"));
    EXPECT_THAT(readme, HasSubstr("| few | ept |"));
    EXPECT_THAT(readme, HasSubstr("\n<!-- /scree bench -->\nafter\n"));
    EXPECT_THAT(readme, Not(HasSubstr("old")));
    check_xml(read_bytes(folder_.path("out/few.svg")));
    const std::string page = read_bytes(folder_.path("out/index.html"));
    check_xml(page.substr(page.find("<html")));
    EXPECT_EQ(json::parse(read_bytes(folder_.path("out/suite.json")))["scenes"].size(), 1u);
    EXPECT_TRUE(std::filesystem::exists(folder_.path("out/details/few/index.html")));
    std::ofstream(folder_.path("text.md")) << "no marks";
    run({"--suite", path("suite.json"), "-o", path("out"), "--readme", path("text.md")});
    EXPECT_THAT(wrong_, HasSubstr("<!-- scree bench -->"));
}

TEST(BenchWords, SaysWhatIsNotMeasured)
{
    ErrorEstimate estimate;
    estimate.squared_bias = {-1e-6, 1e-4};
    EXPECT_THAT(bias_words(estimate.squared_bias), HasSubstr("not measured (< 1.4 %)"));
    estimate.squared_bias = {4e-4, 1e-4};
    EXPECT_THAT(bias_words(estimate.squared_bias), HasSubstr("2 % (1.4 to 2.4)"));
    estimate.squared_error = {1e-4, 0};
    estimate.reference_noise = {4e-4, 0};
    EXPECT_THAT(error_words(estimate), HasSubstr("< 2 % (reference)"));
}

} // namespace
} // namespace scree
