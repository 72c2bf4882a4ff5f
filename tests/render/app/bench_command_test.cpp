// scree bench from end to end on a scene of some grains.

#include "base/drawing/svg_plot.h"
#include "base/error.h"
#include "render/app/bench_command.h"
#include "render/bench/bench_page.h"
#include "render/bench/bench_run.h"
#include "render/bench/bench_words.h"
#include "render/bench/exr_planes.h"
#include "render/bench/suite_run.h"
#include "tests/builders/scene_files.h"

#include <CLI/CLI.hpp>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <limits>

namespace scree {
namespace {

using namespace test;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Throws if the text is not well-formed XML.
void check_xml(const std::string& text)
{
    std::istringstream stream(text);
    boost::property_tree::ptree tree;
    boost::property_tree::read_xml(stream, tree);
}

/// Expects that the table in a text fits on a screen.
void expect_narrow(const std::string& text)
{
    std::istringstream lines(text.substr(text.find("scene "), text.find("page:") - text.find("scene ")));
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
}

class BenchCommand : public testing::Test {
protected:
    BenchCommand() : scene_(standard_scene().write(folder_)) {}

    std::string path(const std::string& name) const { return folder_.path(name).string(); }
    /// Returns what the command prints; its error message is in wrong_.
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
        return {scene_,  "-o",     path(folder), "--integrators",    "auto,ept", "--size",
                "24x18", "--time", "0.2",        "--reference-time", "0.2"};
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
    expect_narrow(text);
    const json numbers = json::parse(read_bytes(folder_.path("out/bench.json")));
    ASSERT_EQ(numbers["methods"].size(), 2u);
    EXPECT_EQ(numbers["methods"][0]["method"], "auto standard");
    EXPECT_EQ(numbers["job"]["seconds"], 0.2);
    EXPECT_EQ(numbers["machine"]["build"].get<std::string>().size(), 16u);
    EXPECT_GT(numbers["methods"][0]["gain_over_ept"]["standard_error"].get<double>(), 0);
    for (const json& method : numbers["methods"]) {
        EXPECT_GT(method["set_up"]["wall_seconds"].get<double>(), 0);
        EXPECT_GT(method["spp"].get<int>(), 4);
        EXPECT_GT(method["noise"]["value"].get<double>(), 0);
        EXPECT_GT(method["segments_per_processor_second"].get<double>(), 0);
        EXPECT_FALSE(method["bias_measured"].get<bool>());
        EXPECT_GE(method["convergence"].size(), 3u);
        EXPECT_LT(method["convergence"].back()["squared_error"]["value"].get<double>(),
                  method["convergence"].front()["squared_error"]["value"].get<double>());
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
    EXPECT_EQ(reference()["spp"], first["spp"]); // the file has as much as was asked for
    std::vector<std::string> longer = quick("out");
    longer.back() = "0.8";
    run(longer);
    EXPECT_EQ(wrong_, "");
    EXPECT_GT(reference()["spp"].get<int>(), 2 * first["spp"].get<int>());
    EXPECT_GT(reference()["processor_seconds"].get<double>(), 2 * first["processor_seconds"].get<double>());
    std::vector<std::string> other = quick("out");
    other.insert(other.end(), {"--seed", "3"});
    run(other);
    EXPECT_LT(reference()["spp"].get<int>(), 2 * first["spp"].get<int>()); // another seed: from the start
}

TEST_F(BenchCommand, TakesAPictureAsReference)
{
    run(quick("out"));
    std::vector<std::string> arguments{
        scene_,   "-o",  path("again"), "--integrators",          "ept", "--size", "24x18",
        "--time", "0.2", "--reference", path("out/reference.exr")};
    run(arguments);
    EXPECT_EQ(wrong_, "");
    const json numbers = json::parse(read_bytes(folder_.path("again/bench.json")));
    EXPECT_TRUE(numbers["reference"]["noise_known"].get<bool>());
    arguments[6] = "20x18";
    run(arguments);
    EXPECT_THAT(wrong_, HasSubstr("24x18"));
}

TEST_F(BenchCommand, MakesAReferenceOfAnotherBuildAgain)
{
    run(quick("out"));
    const std::filesystem::path file = folder_.path("out/reference.exr");
    ExrPlanes planes = read_exr_planes(file);
    std::string& key = planes.texts["referenceKey"];
    key.back() = key.back() == '0' ? '1' : '0';
    planes.numbers = {{"processorSeconds", 1000}, {"secondsAsked", 1000}, {"spp", 100}, {"shareOfA", 0.5}};
    write_exr_planes(file, planes);
    EXPECT_THAT(run(quick("out")), HasSubstr("of another build"));
    const json reference = json::parse(read_bytes(folder_.path("out/bench.json")))["reference"];
    EXPECT_LT(reference["processor_seconds"].get<double>(), 100);
    EXPECT_EQ(read_exr_planes(folder_.path("out/reference-before.exr")).numbers.at("processorSeconds"), 1000);
}

TEST_F(BenchCommand, SaysThatAReferenceIsOfAnotherScene)
{
    run(quick("out"));
    const auto with = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{
            scene_,   "-o",  path("again"), "--integrators",          "ept", "--size", "24x18",
            "--time", "0.1", "--reference", path("out/reference.exr")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    };
    EXPECT_THAT(with({}), Not(HasSubstr("another scene")));
    EXPECT_THAT(with({"-D", "camera.fov=41"}), HasSubstr("another scene"));
}

TEST_F(BenchCommand, SaysWhatAReferenceOfUnknownNoiseLeavesOpen)
{
    render_picture(scene_, [](RenderJob& job) { job.set("--size", "24x18"); });
    ExrPlanes plain = read_exr_planes(folder_.path("out.exr"));
    std::erase_if(plain.planes, [](const auto& plane) { return plane.first.size() > 1; });
    plain.numbers.clear();
    write_exr_planes(folder_.path("plain.exr"), plain);
    EXPECT_THAT(run({scene_, "-o", path("out"), "--integrators", "ept", "--size", "24x18", "--time", "0.1",
                     "--reference", path("plain.exr")}),
                HasSubstr("(with ref.)"));
    const json numbers = json::parse(read_bytes(folder_.path("out/bench.json")));
    EXPECT_FALSE(numbers["reference"]["noise_known"].get<bool>());
    EXPECT_TRUE(numbers["methods"][0]["mrse"]["standard_error"].is_null());
    EXPECT_TRUE(numbers["methods"][0]["color_error"]["r"]["standard_error"].is_null());
}

/// A job of ept with two pictures.
BenchJob job_of(const std::string& scene, double seconds)
{
    BenchJob job;
    job.scene.scene = scene;
    job.scene.threads = 1;
    job.methods = parse_methods("ept", "");
    job.seconds = seconds;
    job.seeds = 2;
    return job;
}

// All pictures have one sample a pixel: a shared sample would make them the same.
TEST_F(BenchCommand, SharesNoSampleWithAPictureOfTheSameSeed)
{
    BenchJob job = job_of(scene_, 1e-9);
    const auto render = [&](uint64_t seed) {
        render_picture(scene_, [&](RenderJob& j) {
            j.spp = 1;
            j.set("--integrator", "ept");
            j.options.seed = seed;
        });
        return read_reference(folder_.path("out.exr"), 40, 30).picture.a;
    };
    const std::vector<V3d> picture = render(0);
    const auto same = [&](const std::vector<V3d>& other) {
        size_t count = 0;
        for (size_t p = 0; p < other.size(); ++p) count += (other[p] - picture[p]).length() < 1e-5;
        return static_cast<double>(count) / static_cast<double>(other.size());
    };
    EXPECT_EQ(same(render(0)), 1); // so a shared sample would show
    EXPECT_LT(same(render(1)), 0.5);
    job.reference = folder_.path("out.exr");
    const BenchResult result = run_bench(job, Progress());
    ASSERT_EQ(result.methods[0].samples, 2u);
    EXPECT_LT(same(result.methods[0].picture.a), 0.5);
    EXPECT_LT(same(result.methods[0].picture.b), 0.5);
}

TEST_F(BenchCommand, FindsABiasedMethod)
{
    render_picture(scene_, [](RenderJob& job) {
        job.set("--size", "24x18");
        job.spp = 2000;
        job.set("--aov", "variance");
        job.set("--integrator", "ept");
    });
    BenchJob job = job_of(scene_, 0.5);
    job.scene.set("--size", "24x18");
    job.reference = folder_.path("out.exr");
    EXPECT_FALSE(run_bench(job, Progress()).methods[0].estimate.squared_bias.is_above_zero());
    job.scene.set("--max-depth", "2"); // leaves light out
    const ErrorEstimate biased = run_bench(job, Progress()).methods[0].estimate;
    EXPECT_TRUE(biased.squared_bias.is_above_zero())
        << biased.squared_bias.value << " +- " << biased.squared_bias.error;
    EXPECT_LT(biased.color[0].value, -3 * biased.color[0].error);
    EXPECT_GT(biased.squared_error.value, biased.noise.value);
}

TEST_F(BenchCommand, KeepsTheReferenceAndOldPagesWhenInterrupted)
{
    BenchJob job = job_of(scene_, 0.2);
    job.title = "few";
    job.scene.set("--size", "24x18");
    job.reference_seconds = 0.4;
    SuiteResult suite{"", 1, 0, {}};
    run_suite({job}, suite, folder_.path("out"), "", Progress());
    const std::string page = read_bytes(folder_.path("out/README.md")), plot = read_bytes(folder_.path("out/few.svg"));
    BenchJob other = job;
    other.title = "other";
    Progress* running = nullptr;
    Progress progress([&](const std::string& stage, double done) {
        if (stage == "reference" && done > 0.3) running->cancel();
    });
    running = &progress;
    suite.scenes.clear();
    EXPECT_THROW(run_suite({job, other}, suite, folder_.path("out"), "", progress), Cancelled);
    EXPECT_EQ(suite.scenes.size(), 1u); // the first run had made its reference
    EXPECT_EQ(read_bytes(folder_.path("out/README.md")), page);
    EXPECT_EQ(read_bytes(folder_.path("out/few.svg")), plot);
    EXPECT_FALSE(std::filesystem::exists(folder_.path("out/other.svg")));
    const ExrPlanes reference = read_exr_planes(folder_.path("out/details/other/reference.exr"));
    EXPECT_GT(reference.numbers.at("spp"), 1);
    EXPECT_LT(reference.numbers.at("secondsAsked"), 0.3);
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
    EXPECT_THAT(complaint({scene_, "-o", path("x"), "--suite-scale", "2"}), HasSubstr("--suite-scale"));
    EXPECT_THAT(complaint({scene_, "-o", path("x"), "--integrators", "ept", "--accuracy", "draft"}),
                HasSubstr("add auto"));
}

TEST_F(BenchCommand, RunsASuiteAndPutsItIntoAText)
{
    std::ofstream(folder_.path("suite.json"))
        << R"({"scenes": [{"name": "few", "scene": ")" << std::filesystem::path(scene_).filename().string()
        << R"(", "size": [16, 12], "integrators": ["ept"], "time": 0.2, "reference_time": 0.2}]})";
    std::ofstream(folder_.path("text.md")) << "before\n<!-- scree bench -->\nold\n<!-- /scree bench -->\nafter\n";
    const std::string text =
        run({"--suite", path("suite.json"), "-o", path("out"), "--readme", path("text.md"), "--suite-scale", "0.5"});
    EXPECT_EQ(wrong_, "");
    EXPECT_THAT(text, HasSubstr("few"));
    expect_narrow(text);
    const std::string readme = read_bytes(folder_.path("text.md"));
    EXPECT_THAT(readme, HasSubstr("before\n<!-- scree bench -->\n"));
    EXPECT_THAT(readme, HasSubstr("| few | ept |"));
    EXPECT_THAT(readme, HasSubstr("| few | reference |"));
    EXPECT_THAT(readme, HasSubstr("\n<!-- /scree bench -->\nafter\n"));
    EXPECT_THAT(readme, Not(HasSubstr("\nold\n")));
    check_xml(read_bytes(folder_.path("out/few.svg")));
    const std::string page = read_bytes(folder_.path("out/index.html"));
    check_xml(page.substr(page.find("<html")));
    EXPECT_THAT(readme, HasSubstr("--suite-scale 0.5"));
    const json suite = json::parse(read_bytes(folder_.path("out/suite.json")));
    EXPECT_EQ(suite["scenes"].size(), 1u);
    EXPECT_EQ(suite["scale"], 0.5);
    EXPECT_EQ(suite["threads"], 1);
    EXPECT_GT(suite["processor_share"].get<double>(), 0.01);
    EXPECT_TRUE(std::filesystem::exists(folder_.path("out/details/few/index.html")));
    std::ofstream(folder_.path("text.md")) << "no marks";
    run({"--suite", path("suite.json"), "-o", path("out"), "--readme", path("text.md")});
    EXPECT_THAT(wrong_, HasSubstr("<!-- scree bench -->"));
}

TEST(BenchWords, SaysWhatIsNotMeasured)
{
    ErrorEstimate estimate;
    estimate.squared_bias = {-1e-6, 1e-4};
    EXPECT_EQ(bias_words(estimate.squared_bias), "< 1.4 %");
    estimate.squared_bias = {4e-4, 1e-4};
    EXPECT_EQ(bias_words(estimate.squared_bias), "2 % (1.4 to 2.4)");
    estimate.squared_error = {1e-4, 0};
    estimate.reference_noise = {4e-4, 0};
    EXPECT_EQ(error_words(estimate), "< 2 % (ref.)");
    estimate.reference_noise.error = estimate.squared_error.error = std::numeric_limits<double>::infinity();
    EXPECT_EQ(error_words(estimate), "1 % (with ref.)");
}

TEST(BenchWords, GivesGainsWithTheirError)
{
    BenchResult result;
    result.methods.resize(2);
    for (size_t m = 0; m < 2; ++m) {
        result.methods[m].name = m == 0 ? "ept" : "ppt";
        result.methods[m].time.processor = 10;
        result.methods[m].estimate.noise = m == 0 ? Measured{0.04, 0.0012} : Measured{0.01, 0.0004};
    }
    EXPECT_EQ(gain_words(result, result.methods[1]), "4.0 +- 0.2 x"); // errors of 3 and 4 % make 5 %
    EXPECT_EQ(gain_words(result, result.methods[0]), "1");
}

TEST(MemoryMeter, LeavesTheProgramsPeak)
{
    constexpr size_t bytes = size_t{96} << 20;
    {
        const std::vector<char> large(bytes, 1);
    }
    const uint64_t peak = peak_bytes();
    EXPECT_GT(peak, bytes);
    const MemoryMeter meter;
    EXPECT_LT(meter.peak(), bytes / 4);
    EXPECT_GE(peak_bytes(), peak);
}

} // namespace
} // namespace scree
