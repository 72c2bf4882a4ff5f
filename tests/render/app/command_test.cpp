// `scree render` as a user sees it: the built program, its exit codes, messages and files.

#include "render/app/render_command.h"
#include "tests/builders/scene_files.h"
#include "tests/builders/scree_process.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace scree {
namespace {

using namespace test;
using testing::HasSubstr;

class Command : public testing::Test {
protected:
    Command() : scene_(standard_scene().write(folder_)) {}

    /// Runs `scree render scene.json -o out.exr --spp 2` and these arguments.
    ProgramRun render(std::vector<std::string> arguments) const
    {
        arguments.insert(arguments.begin(), {"render", scene_, "-o", path("out.exr"), "--spp", "2"});
        return run_scree(arguments);
    }
    std::string path(const std::string& name) const { return folder_.path(name).string(); }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_.path(name)); }
    /// The names of all files in the folder, to check that nothing was left behind.
    std::string files() const
    {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return fmt::format("{}", fmt::join(names, " "));
    }

    TemporaryFolder folder_;
    std::string scene_;
};

TEST_F(Command, TellsItsVersion)
{
    const ProgramRun run = run_scree({"--version"});
    EXPECT_EQ(run.status, 0);
    EXPECT_THAT(run.out, HasSubstr(SCREE_VERSION));
}

TEST_F(Command, HelpNamesEveryOption)
{
    const ProgramRun run = run_scree({"render", "--help"});
    EXPECT_EQ(run.status, 0);
    for (const char* option : {"--output", "--spp", "--timeout", "--integrator", "--frames", "--size", "--cropwindow",
                               "--pixelbounds", "--aov", "--threads", "--seed", "--max-depth", "--resume", "--plan",
                               "--stats", "--stats-json", "--debug-sample", "-D", "--quiet"}) {
        EXPECT_THAT(run.out, HasSubstr(option));
    }
}

TEST_F(Command, QuietPrintsNothing)
{
    const ProgramRun run = render({"-q"});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(files(), "ball.obj cube.obj floor.obj grains.dump out.exr scene.json");
}

TEST_F(Command, ProgressIsAFewLinesInALog)
{
    const ProgramRun run = render({});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.err, HasSubstr("rendering"));
    EXPECT_THAT(run.err, testing::Not(HasSubstr("\r")));
    EXPECT_LE(std::count(run.err.begin(), run.err.end(), '\n'), 60);
}

TEST_F(Command, IsTheSameAsTheLibrary)
{
    ASSERT_EQ(render({"-q", "--seed", "5", "-t", "1"}).status, 0);
    const Picture picture = read_picture(path("out.exr"));
    const Picture expected = render_picture(scene_, [](RenderJob& job) {
        job.spp = 2;
        job.options.seed = 5;
    });
    EXPECT_EQ(difference(picture, expected), "");
}

TEST_F(Command, PlanBuildsAndWritesNothing)
{
    const std::string before = files();
    const ProgramRun run = render({"--plan"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(files(), before);
    for (const char* line : {"40x30", "built", "skipped", "grains", "exemplar 'cube'", "40 of 40 spheres", "1 meshes",
                             "next-event", "frame 0 of 1"}) {
        EXPECT_THAT(run.out, HasSubstr(line));
    }
}

TEST_F(Command, WritesStatistics)
{
    const ProgramRun run = render({"-q", "--stats-json", path("stats.json")});
    ASSERT_EQ(run.status, 0) << run.err;
    std::ifstream file(path("stats.json"));
    const auto stats = nlohmann::json::parse(file);
    EXPECT_EQ(stats.at("version"), SCREE_VERSION);
    EXPECT_GT(stats.at("peak_memory_bytes").get<double>(), 1e6);
    ASSERT_EQ(stats.at("frames").size(), 1u);
    const auto& frame = stats.at("frames")[0];
    EXPECT_EQ(frame.at("spp"), 2);
    EXPECT_EQ(frame.at("paths"), 2 * 40 * 30);
    EXPECT_EQ(frame.at("grains"), 40);
    EXPECT_EQ(frame.at("non_finite"), 0);
    EXPECT_EQ(frame.at("cancelled"), false);
    EXPECT_GE(frame.at("segments").get<int>(), 2 * 40 * 30);
}

TEST_F(Command, StatisticsAreText)
{
    const ProgramRun run = render({"-q", "--stats"});
    EXPECT_EQ(run.status, 0);
    for (const char* word : {"segments", "shadow rays", "peak memory", "2 samples a pixel"})
        EXPECT_THAT(run.out, HasSubstr(word));
}

TEST_F(Command, ReplaysASample)
{
    // With one sample per pixel, the picture is that sample.
    const Picture picture = render_picture(scene_, [](RenderJob& job) { job.spp = 1; });
    std::filesystem::remove(path("out.exr"));
    for (const auto& [x, y] : {std::pair{20, 15}, {39, 0}}) {
        const ProgramRun run = render({"--debug-sample", fmt::format("{},{},0", x, y)});
        EXPECT_EQ(run.status, 0) << run.err;
        const size_t i = picture.index(x, y);
        EXPECT_THAT(run.out,
                    HasSubstr(fmt::format("pixel {},{} sample 0: radiance {} {} {}", x, y, picture.floats.at("R")[i],
                                          picture.floats.at("G")[i], picture.floats.at("B")[i])));
        EXPECT_THAT(run.out, HasSubstr("   0 from ("));
    }
    EXPECT_FALSE(exists("out.exr"));
}

TEST_F(Command, NamesFrames)
{
    SceneFiles files_of = standard_scene();
    files_of.frames.resize(4, files_of.frames[0]);
    files_of.write(folder_);
    const ProgramRun range = run_scree({"render", scene_, "-q", "--spp", "1", "--frames", "1:3:2", "-o",
                                        path("film.exr"), "-o", path("small_%02d.png")});
    EXPECT_EQ(range.status, 0) << range.err;
    EXPECT_EQ(
        files(),
        "ball.obj cube.obj film.0001.exr film.0003.exr floor.obj grains.dump scene.json small_01.png small_03.png");
    EXPECT_EQ(run_scree({"render", scene_, "-q", "--spp", "1", "--frames", "2", "-o", path("one.exr")}).status, 0);
    EXPECT_TRUE(exists("one.exr"));
}

TEST_F(Command, TheDefaultNameIsTheScenes)
{
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder_.path());
    const ProgramRun run = run_scree({"render", "scene.json", "-q", "--spp", "1"});
    std::filesystem::current_path(before);
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(exists("scene.exr"));
}

TEST_F(Command, CropsByWindowAndByPixels)
{
    ASSERT_EQ(render({"-q"}).status, 0);
    const Picture whole = read_picture(path("out.exr"));
    ASSERT_EQ(render({"-q", "--cropwindow", "0.25,0.75,0.1,0.5"}).status, 0);
    const Picture crop = read_picture(path("out.exr"));
    EXPECT_EQ(crop.data, Imath::Box2i({10, 3}, {29, 14}));
    EXPECT_EQ(difference(crop, whole), "");
    ASSERT_EQ(render({"-q", "--pixelbounds", "3,7,4,5"}).status, 0);
    const Picture pixels = read_picture(path("out.exr"));
    EXPECT_EQ(pixels.data, Imath::Box2i({3, 4}, {6, 4}));
    EXPECT_EQ(difference(pixels, whole), "");
}

TEST_F(Command, WritesPreviews)
{
    ASSERT_EQ(render({"-q", "-o", path("out.png"), "-o", path("out.jpg"), "--cropwindow", "0,0.5,0,1"}).status, 0);
    const std::string png = read_bytes(path("out.png"));
    ASSERT_GT(png.size(), 100u);
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    // IHDR: width, height, big-endian; 8 bits; RGB.
    EXPECT_EQ(png.substr(16, 10), std::string("\0\0\0\x14\0\0\0\x1e\x08\x02", 10));
    EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
    EXPECT_EQ(read_bytes(path("out.jpg")).substr(0, 3), "\xff\xd8\xff");
}

TEST_F(Command, OverridesTheScene)
{
    ASSERT_EQ(render({"-q", "-D", "camera.fov=30", "-D", "film.filter=\"box\"", "-D", "/film/size=[8, 6]", "--aov",
                      "depth,samples"})
                  .status,
              0);
    EXPECT_EQ(read_picture(path("out.exr")).width(), 8);
    ASSERT_EQ(render({"-q", "--size", "9x5"}).status, 0);
    EXPECT_EQ(read_picture(path("out.exr")).height(), 5);
    // A bare word is a string.
    EXPECT_EQ(render({"--plan", "-D", "integrator.kind=ept"}).status, 0);
}

TEST_F(Command, TimeoutStopsInTime)
{
    const ProgramRun run = run_scree({"render", scene_, "-o", path("out.exr"), "--size", "320x240", "--timeout", "1"});
    EXPECT_EQ(run.status, 0);
    EXPECT_GT(run.seconds, 1);
    EXPECT_LT(run.seconds, 3);
    EXPECT_GE(read_picture(path("out.exr")).numbers.at("spp"), 1);
    EXPECT_FALSE(exists("out.exr.checkpoint")) << "without --spp there is nothing to continue";
    const ProgramRun cut =
        run_scree({"render", scene_, "-o", path("out.exr"), "--size", "320x240", "--timeout", "1", "--spp", "1000000"});
    EXPECT_EQ(cut.status, 0);
    EXPECT_LT(cut.seconds, 3);
    EXPECT_THAT(cut.err, HasSubstr("stopped by --timeout"));
    EXPECT_TRUE(exists("out.exr.checkpoint"));
}

// Ctrl-C writes the samples so far; --resume completes them to the same bits.
TEST_F(Command, InterruptedAndResumedIsTheSameAsInOneGo)
{
    const std::vector<std::string> base{"render", scene_, "--size", "120x90", "-o", path("out.exr")};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), base.begin(), base.end());
        return more;
    };
    // Enough samples for some seconds on this machine.
    ASSERT_EQ(run_scree(with({"-q", "--timeout", "0.3"})).status, 0);
    const auto spp = std::to_string(std::max(8, static_cast<int>(4 * read_picture(path("out.exr")).numbers.at("spp"))));
    const ProgramRun stopped = run_scree(with({"--spp", spp}), "rendering", 0.2);
    ASSERT_EQ(stopped.status, 130) << stopped.err;
    EXPECT_THAT(stopped.err, HasSubstr("interrupted"));
    EXPECT_THAT(stopped.err, HasSubstr("--resume"));
    const Picture partial = read_picture(path("out.exr"));
    EXPECT_LT(partial.numbers.at("spp"), std::stof(spp));
    EXPECT_TRUE(partial.all_finite());
    ASSERT_TRUE(exists("out.exr.checkpoint"));

    const ProgramRun resumed = run_scree(with({"--spp", spp, "--resume", "-q"}));
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    const Picture complete = read_picture(path("out.exr"));
    EXPECT_FALSE(exists("out.exr.checkpoint"));
    ASSERT_EQ(run_scree(with({"--spp", spp, "-q"})).status, 0);
    EXPECT_EQ(difference(complete, read_picture(path("out.exr"))), "");
    EXPECT_EQ(files(), "ball.obj cube.obj floor.obj grains.dump out.exr scene.json");
}

TEST_F(Command, InterruptedFilmKeepsTheFramesBefore)
{
    SceneFiles files_of = standard_scene();
    files_of.frames.resize(50, files_of.frames[0]);
    files_of.write(folder_);
    const ProgramRun run = run_scree({"render", scene_, "--size", "80x60", "--spp", "100000", "--frames", "0:49", "-o",
                                      path("f.exr"), "--stats-json", path("stats.json")},
                                     "rendering", 0.1);
    EXPECT_EQ(run.status, 130);
    EXPECT_TRUE(exists("f.0000.exr"));
    EXPECT_TRUE(exists("f.0000.exr.checkpoint"));
    EXPECT_FALSE(exists("f.0049.exr"));
    const auto stats = nlohmann::json::parse(read_bytes(path("stats.json")));
    EXPECT_EQ(stats.at("frames").back().at("cancelled"), true);
}

// --- wrong calls ---

struct WrongCall {
    std::vector<std::string> arguments;
    std::string message; ///< a substring of the message
};

/// Runs the render command in this process (starting the program takes a third of a second) and returns its error
/// message.
std::string message_of(std::vector<std::string> arguments)
{
    CLI::App app;
    add_render_command(app);
    std::reverse(arguments.begin(), arguments.end()); // the order that CLI11 expects
    try {
        app.parse(arguments);
    } catch (const CLI::Error& error) {
        return error.what();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

const std::vector<WrongCall> wrong_calls{WrongCall{{"--no-such-flag"}, "--no-such-flag"},
                                         WrongCall{{"other.json"}, "other.json"},
                                         WrongCall{{"--size", "10"}, "--size"},
                                         WrongCall{{"--size", "10x"}, "--size"},
                                         WrongCall{{"--size", "0x5"}, "--size"},
                                         WrongCall{{"--size", "10x-5"}, "--size"},
                                         WrongCall{{"--size", "10.5x20"}, "--size"},
                                         WrongCall{{"--size", "1e9x1"}, "--size"},
                                         WrongCall{{"--size", "10x20x30"}, "--size"},
                                         WrongCall{{"--size", "axb"}, "--size"},
                                         WrongCall{{"--cropwindow", "0,1,0"}, "--cropwindow"},
                                         WrongCall{{"--cropwindow", "0,1.5,0,1"}, "0 <= x0"},
                                         WrongCall{{"--cropwindow", "0.5,0.5,0,1"}, "--cropwindow"},
                                         WrongCall{{"--cropwindow", "a,b,c,d"}, "--cropwindow"},
                                         WrongCall{{"--cropwindow", "nan,1,0,1"}, "--cropwindow"},
                                         WrongCall{{"--pixelbounds", "1,2,3"}, "--pixelbounds"},
                                         WrongCall{{"--pixelbounds", "5,4,0,1"}, "no pixel"},
                                         WrongCall{{"--pixelbounds", "0,1e30,0,1"}, "--pixelbounds"},
                                         WrongCall{{"--pixelbounds", "0.5,3,0,1"}, "whole numbers"},
                                         WrongCall{{"--pixelbounds", "100,200,0,5"}, "40x30"},
                                         WrongCall{{"--frames", "x"}, "--frames"},
                                         WrongCall{{"--frames", "3:1"}, "A <= B"},
                                         WrongCall{{"--frames", "0:1:0"}, "STEP"},
                                         WrongCall{{"--frames=-1"}, "--frames"},
                                         WrongCall{{"--frames", "0:9"}, "the dump has 1 frames"},
                                         WrongCall{{"--frames", "1:2:3:4"}, "--frames"},
                                         WrongCall{{"--frames", "0.5"}, "--frames"},
                                         WrongCall{{"--spp", "0"}, "--spp"},
                                         WrongCall{{"--spp", "many"}, "--spp"},
                                         WrongCall{{"--spp=-3"}, "--spp"},
                                         WrongCall{{"--timeout", "0"}, "--timeout"},
                                         WrongCall{{"--timeout=-1"}, "--timeout"},
                                         WrongCall{{"--timeout", "soon"}, "--timeout"},
                                         WrongCall{{"-t", "0"}, "--threads"},
                                         WrongCall{{"--seed=-1"}, "--seed"},
                                         WrongCall{{"--max-depth=-1"}, "--max-depth"},
                                         WrongCall{{"--integrator", "magic"}, "--integrator"},
                                         WrongCall{{"--aov", "albdo"}, "albedo"},
                                         WrongCall{{"--debug-sample", "1,2"}, "--debug-sample"},
                                         WrongCall{{"--debug-sample", "1,2,-3"}, "--debug-sample"},
                                         WrongCall{{"--debug-sample", "40,2,0"}, "40x30"},
                                         WrongCall{{"--debug-sample", "1e30,2,0"}, "--debug-sample"},
                                         WrongCall{{"-D", "camera.fov"}, "key=value"},
                                         WrongCall{{"-D", "camera.fovv=3"}, "did you mean 'fov'"},
                                         WrongCall{{"-D", "camera.fov=wide"}, "/camera/fov"},
                                         WrongCall{{"-D", "camera.fov.deep=3"}, "-D camera.fov.deep"},
                                         WrongCall{{"-o", "FOLDER/name"}, "extension"},
                                         WrongCall{{"-o", "FOLDER/x.unknown"}, ".unknown"},
                                         WrongCall{{"-o", "FOLDER/no/x.exr"}, "no folder"},
                                         WrongCall{{"-o", "/proc/x.exr"}, "/proc/x.exr"},
                                         WrongCall{{"-o", "FOLDER/%5x.exr"}, "%04d"},
                                         WrongCall{{"--stats-json", "FOLDER/no/stats.json"}, "no/stats.json"},
                                         WrongCall{{"--resume", "-D", "film.size=[0, 1]"}, "/film/size/0"}};

TEST_F(Command, WrongCallsAreToldInOneMessageBeforeTheWork)
{
    const std::string before = files();
    for (const WrongCall& call : wrong_calls) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(call.arguments, " ")));
        std::vector<std::string> arguments{"render", scene_, "--spp", "1"};
        for (const std::string& word : call.arguments)
            arguments.push_back(replace_all(word, "FOLDER", folder_.path().string()));
        if (std::find(arguments.begin(), arguments.end(), "-o") == arguments.end())
            arguments.insert(arguments.end(), {"-o", path("out.exr")});
        testing::internal::CaptureStderr();
        EXPECT_THAT(message_of(arguments), HasSubstr(call.message));
        EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::Not(HasSubstr("rendering")));
        EXPECT_EQ(files(), before);
    }
}

TEST_F(Command, WrongCallsExitWithTwo)
{
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{"--no-such-flag"}, {"--size", "10"}, {"--spp", "0"}, {"-o", path("no/x.exr")}}) {
        const ProgramRun run = render(more);
        EXPECT_EQ(run.status, 2) << run.err;
        EXPECT_EQ(run.out, "");
        EXPECT_THAT(run.err, HasSubstr(more[0] == "-o" ? "--output" : more[0]));
        EXPECT_LE(std::count(run.err.begin(), run.err.end(), '\n'), 2);
        EXPECT_FALSE(exists("out.exr"));
    }
}

TEST_F(Command, MissingFilesAreNamed)
{
    const ProgramRun scene = run_scree({"render", path("nothing.json"), "-o", path("out.exr")});
    EXPECT_EQ(scene.status, 2);
    EXPECT_THAT(scene.err, HasSubstr("nothing.json"));
    for (const char* file : {"grains.dump", "floor.obj", "cube.obj"}) {
        const std::string bytes = read_bytes(path(file));
        std::filesystem::remove(path(file));
        EXPECT_THAT(message_of({"render", scene_, "-q", "-o", path("out.exr")}), HasSubstr(file));
        EXPECT_FALSE(exists("out.exr"));
        folder_.write(file, bytes);
    }
    EXPECT_EQ(run_scree({}).status, 2);
    EXPECT_EQ(run_scree({"rendr"}).status, 2);
}

TEST_F(Command, AFolderInPlaceOfThePictureIsToldBeforeTheWork)
{
    std::filesystem::create_directory(path("out.exr"));
    const ProgramRun run = render({});
    EXPECT_EQ(run.status, 2);
    EXPECT_THAT(run.err, HasSubstr("out.exr"));
    EXPECT_THAT(run.err, testing::Not(HasSubstr("rendering")));
}

TEST_F(Command, UpperCaseExtensionsAreTheSameFormats)
{
    ASSERT_EQ(render({"-q"}).status, 0);
    ASSERT_EQ(run_scree({"render", scene_, "-q", "--spp", "2", "-o", path("OUT.EXR")}).status, 0);
    EXPECT_EQ(difference(read_picture(path("OUT.EXR")), read_picture(path("out.exr"))), "");
}

} // namespace
} // namespace scree
