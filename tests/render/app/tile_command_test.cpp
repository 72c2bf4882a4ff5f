#include "packing/tiles/packing_tile.h"
#include "render/app/pack_command.h"
#include "tests/builders/test_files.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

namespace scree {
namespace {

using testing::HasSubstr;

class TileCommand : public testing::Test {
protected:
    std::string run(std::vector<std::string> words)
    {
        CLI::App app;
        add_pack_tile_command(app);
        words.insert(words.begin(), "tile");
        std::ranges::reverse(words);
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        try {
            app.parse(words);
        } catch (...) {
            testing::internal::GetCapturedStdout();
            testing::internal::GetCapturedStderr();
            throw;
        }
        std::fflush(stdout);
        testing::internal::GetCapturedStderr();
        return testing::internal::GetCapturedStdout();
    }
    std::string error(const std::vector<std::string>& words)
    {
        const auto found = test::input_error_of([&] { run(words); });
        return found ? std::string(found->what()) : "none";
    }
    std::string path(const std::string& name) { return folder_.path(name).string(); }

    /// A dump of an n^3 lattice at spacing 1, of spheres of radius `radius` and two types.
    std::string lattice(int n, double radius, const std::string& bounds = "pp pp pp")
    {
        std::string text =
            fmt::format("ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {}\n", n * n * n, bounds);
        for (int axis = 0; axis < 3; ++axis) text += fmt::format("{} {}\n", -1.0 * axis, -1.0 * axis + n);
        text += "ITEM: ATOMS id type x y z radius\n";
        for (int i = 0; i < n * n * n; ++i)
            text += fmt::format("{} {} {} {} {} {}\n", i + 1, i % 2 + 1, i % n + 0.03 * (i % 5),
                                i / n % n - 1.0 + 0.03 * (i % 7), i / n / n - 2.0, radius);
        return folder_.write("lattice.dump", text);
    }

    test::TemporaryFolder folder_;
};

TEST_F(TileCommand, WritesTheSameBytesForTheSameSeed)
{
    const std::vector<std::string> words{"--spheres",  "200", "--fraction", "0.4", "--sweeps", "50",
                                         "--variants", "2",   "--seed",     "3",   "-q"};
    const auto make = [&](const std::string& name, const std::vector<std::string>& more) {
        std::vector<std::string> all{"-o", path(name)};
        all.insert(all.end(), words.begin(), words.end());
        all.insert(all.end(), more.begin(), more.end());
        EXPECT_EQ(run(all), "");
        return read_tile(path(name));
    };
    const PackingTile a = make("a.vdb", {"-t", "1"}), b = make("b.vdb", {"-t", "2"});
    EXPECT_EQ(a.variants, b.variants);
    EXPECT_EQ(a.radius, b.radius);
    EXPECT_EQ(a.variants.size(), 2u);
    EXPECT_NEAR(a.fraction(), 0.4, 1e-6);
}

TEST_F(TileCommand, TellsWhatItMade)
{
    const std::string text = run({"-o", path("a.vdb"), "--spheres", "300", "--sizes", "bidisperse", "ratio=2",
                                  "share=0.2", "--variants", "2", "--size", "1x2x1"});
    EXPECT_THAT(text, HasSubstr("300 spheres, two radii, ratio 2, the larger 20 % by number"));
    EXPECT_THAT(text, HasSubstr("1 x 2 x 1"));
    EXPECT_THAT(text, HasSubstr("2 variants"));
    EXPECT_THAT(text, HasSubstr("jammed"));
    EXPECT_THAT(text, HasSubstr("smallest gap"));
    EXPECT_GT(read_tile(path("a.vdb")).fraction(), 0.58);
    EXPECT_THAT(run({"-o", path("b.vdb"), "--spheres", "300", "--fraction", "0.2", "--variants", "1"}),
                HasSubstr("hard-sphere fluid after"));
}

TEST_F(TileCommand, CutsATileOutOfASimulation)
{
    // With radius 0.4 no overlap is above the allowed one, so spheres stay in place.
    const std::string text = run({"-o", path("a.vdb"), "--from", lattice(6, 0.4), "--variants", "2", "--sweeps", "20"});
    EXPECT_THAT(text, HasSubstr("every sphere is where the dump has it"));
    const PackingTile tile = read_tile(path("a.vdb"));
    EXPECT_EQ(tile.rows(), 216u);
    EXPECT_EQ(tile.size, Imath::V3d(6));
    EXPECT_EQ(std::ranges::count(tile.type, 2), 108);
    EXPECT_FLOAT_EQ(tile.radius[5], 0.4f);
}

TEST_F(TileCommand, PartsTheOverlapsOfASimulation)
{
    // Radius 0.5 at spacing 1, displaced by up to 0.2: pairs overlap by tens of per cent, and a fraction of 0.52 fits.
    const std::string text = run({"-o", path("a.vdb"), "--from", lattice(6, 0.5), "--variants", "2"});
    EXPECT_THAT(text, HasSubstr("the dump's spheres overlapped: they were moved by"));
    EXPECT_THAT(text, HasSubstr("radii are "));
    const PackingTile tile = read_tile(path("a.vdb"));
    EXPECT_GT(tile.radius[0], 0.48f);
    EXPECT_LE(tile.radius[0], 0.5f);
    EXPECT_EQ(tile.variants.size(), 2u);
}

TEST_F(TileCommand, OnlyPeriodicCuboidsCanBeCut)
{
    EXPECT_THAT(error({"-o", path("a.vdb"), "--from", lattice(4, 0.4, "pp ff pp")}), HasSubstr("not periodic along y"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--from", lattice(4, 0.4, "pp ff pp")}), HasSubstr("--region"));
    EXPECT_FALSE(std::filesystem::exists(path("a.vdb")));
    run({"-o", path("a.vdb"), "--from", lattice(6, 0.4, "pp ff pp"), "--region", "0.5,5.5,-0.5,4.5,-1.5,3.5",
         "--variants", "1"});
    EXPECT_EQ(read_tile(path("a.vdb")).size, Imath::V3d(5));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--from", lattice(4, 0.4), "--region", "0,1,0,1,5,4"}),
                HasSubstr("--region"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--from", lattice(4, 0.4), "--region", "50,60,0,10,0,10"}),
                HasSubstr("no particle in the region"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--from", lattice(4, 3)}), HasSubstr("1.5 times the largest diameter"));
}

TEST_F(TileCommand, DrawsRadiiFromADump)
{
    const std::string dump = std::string(SCREE_EXAMPLES) + "/pour/pour.0009.dump.gz";
    run({"-o", path("a.vdb"), "--radii-from", dump, "--spheres", "300", "--fraction", "0.3", "--variants", "1",
         "--sweeps", "5"});
    EXPECT_EQ(read_tile(path("a.vdb")).rows(), 300u);
}

TEST_F(TileCommand, BadWordsAreTold)
{
    EXPECT_THAT(error({"-o", path("a.vdb"), "--spheres", "0"}), HasSubstr("no spheres"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--fraction", "1.5"}), HasSubstr("above 0 and below 1"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--fraction", "mx"}), HasSubstr("or max"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--sizes", "powr"}), HasSubstr("did you mean 'power'"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--size", "1x2"}), HasSubstr("AxBxC"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--size", "1x2xz"}), HasSubstr("AxBxC"));
    EXPECT_THAT(error({"-o", path("a.csv")}), HasSubstr(".vdb"));
    EXPECT_THAT(error({"-o", path("no/such/a.vdb"), "--spheres", "100"}), HasSubstr("no/such"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--from", "a", "--radii-from", "b"}), HasSubstr("one of them"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--region", "0,1,0,1,0,1"}), HasSubstr("--from"));
    EXPECT_THAT(error({"-o", path("a.vdb"), "--spheres", "200", "--fraction", "0.7", "--variants", "1"}),
                HasSubstr("at most 0.6"));
    EXPECT_FALSE(std::filesystem::exists(path("a.vdb")));
}

} // namespace
} // namespace scree
