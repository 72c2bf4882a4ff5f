// Nothing is built that no path can use: there is a scene for each line of `--plan` and of the statistics.

#include "packing/tiles/tile_generator.h"
#include "render/app/render_command.h"
#include "render/scene/scene_description.h"
#include "tests/builders/scene_files.h"
#include "tests/builders/shapes.h"
#include "tests/render/loop/plan_rows.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>

namespace scree {
namespace {

using namespace test;
using nlohmann::json;
using testing::HasSubstr;

struct Line {
    std::string part;
    bool built;
    std::string reason;
    double seconds = 0, bytes = 0;

    /// The part without the name in quotes.
    std::string kind() const { return part.substr(0, part.find(" '")); }
};

/// Runs the render command in this process, because starting the program takes a third of a second.
class PlanLines : public testing::Test {
protected:
    PlanLines()
    {
        setenv("SCREE_CACHE", folder_.path("cache").c_str(), 1);
        std::filesystem::create_directory(folder_.path("cache"));
        write("cube.obj", obj_text(cube()));
        write("floor.obj", obj_text(ground(4, -1)));
        write("slab.obj", obj_text(box_mesh({-4, -4, -1}, {4, 4, 0})));
        write("ball.obj", obj_text(icosphere(2)));
        TileOptions options;
        options.fraction = 0.3;
        options.variants = 1;
        write_tile(make_tile(std::vector<double>(64, 1), options, {}).tile, folder_.path("tile.vdb"));
        openvdb::initialize();
        write_cloud("cloud.vdb", 1);
        write_cloud("empty.vdb", 0);
        run("nothing", {"--size", "8x4", "-D", "lights=[{\"kind\": \"constant\"}]", "-o", path("sky.exr")});
    }
    ~PlanLines() override { unsetenv("SCREE_CACHE"); }

    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_.path(name)) << text; }
    std::string path(const std::string& name) const { return folder_.path(name).string(); }
    void write_cloud(const std::string& name, float density) const
    {
        const auto grid = openvdb::FloatGrid::create(0);
        grid->setName("density");
        if (density > 0) grid->fill(openvdb::CoordBBox({-5, -5, -5}, {5, 5, 5}), density);
        grid->setTransform(openvdb::math::Transform::createLinearTransform(0.2));
        openvdb::io::File(path(name)).write({grid});
    }
    /// The lines of `--plan` (if the arguments contain it) or of the statistics.
    const std::vector<Line>& run(const std::string& scene, const std::vector<std::string>& more)
    {
        const auto [found, is_new] = lines_.try_emplace({scene, more});
        if (!is_new) return found->second;
        write("scene.json",
              R"({"camera": {"origin": [0, -9, 5], "target": [0, 0, 0]}, "film": {"size": [8, 6], "filter": "box"}, )" +
                  scenes_.at(scene) + "}");
        std::vector<std::string> arguments{"render",       path("scene.json"), "-q", "--spp", "1",
                                           "--stats-json", path("stats.json")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        if (std::ranges::find(more, "-o") == more.end()) arguments.insert(arguments.end(), {"-o", path("out.exr")});
        std::filesystem::remove(path("stats.json"));
        CLI::App app;
        add_render_command(app);
        std::ranges::reverse(arguments); // the order that CLI11 expects
        std::string wrong;
        testing::internal::CaptureStdout();
        try {
            app.parse(arguments);
        } catch (const std::exception& error) {
            wrong = error.what();
        }
        const std::string text = testing::internal::GetCapturedStdout();
        EXPECT_EQ(wrong, "") << scene;
        if (!wrong.empty()) return found->second;
        if (std::ranges::find(more, "--plan") != more.end())
            read_plan(text, found->second);
        else
            read_statistics(found->second);
        return found->second;
    }
    static void read_plan(const std::string& text, std::vector<Line>& lines)
    {
        constexpr size_t part_at = 11, reason_at = 38;
        for (const std::string& line : split_lines(text)) {
            const bool built = line.starts_with("  built ");
            if (!built && !line.starts_with("  skipped ")) continue;
            // A part's name ends at its quote, or is shorter than its column.
            const size_t quote = line.find('\''), end = quote < reason_at
                                                            ? line.find("' ", part_at) + 1
                                                            : line.find_last_not_of(' ', reason_at - 1) + 1;
            lines.push_back(
                {line.substr(part_at, end - part_at), built, line.substr(line.find_first_not_of(' ', end))});
        }
    }
    void read_statistics(std::vector<Line>& lines) const
    {
        const json statistics = json::parse(read_bytes(path("stats.json")));
        for (const json& part : statistics.at("frames").back().at("parts")) {
            lines.push_back(
                {part.at("part"), part.at("built"), part.at("reason"), part.at("seconds"), part.at("bytes")});
        }
    }

    TemporaryFolder folder_;
    const std::map<std::string, std::string> scenes_ = plan_scenes();
    std::map<std::pair<std::string, std::vector<std::string>>, std::vector<Line>> lines_;
};

/// Numbers vary; names do not.
std::string without_numbers(const std::string& text)
{
    return std::regex_replace(text, std::regex("[0-9]+([.][0-9]+)?(e[+-]?[0-9]+)?"), "#");
}

const Line* find_line(const std::vector<Line>& lines, const std::string& part)
{
    const auto found = std::ranges::find(lines, part, &Line::part);
    return found == lines.end() ? nullptr : &*found;
}

TEST_F(PlanLines, EveryLineIsPrintedForAScene)
{
    const std::vector<PlanRow> rows = plan_rows();
    for (const PlanRow& row : rows) {
        SCOPED_TRACE(fmt::format("{}: {} {}, {}", row.name, row.scene, fmt::join(row.arguments, " "), row.part));
        const Line* line = find_line(run(row.scene, row.arguments), row.part);
        ASSERT_TRUE(line);
        EXPECT_EQ(line->built, row.built);
        EXPECT_THAT(line->reason, HasSubstr(row.reason));
    }
    // And no line is printed that no row expects.
    std::set<std::tuple<std::string, bool, std::string>> expected;
    for (const PlanRow& row : rows)
        expected.insert({Line{row.part, row.built, ""}.kind(), row.built, without_numbers(row.reason)});
    for (const auto& [call, lines] : lines_) {
        for (const Line& line : lines) {
            const std::string reason = without_numbers(line.reason);
            const bool is_expected = std::ranges::any_of(expected, [&](const auto& row) {
                return std::get<0>(row) == line.kind() && std::get<1>(row) == line.built &&
                       reason.find(std::get<2>(row)) != std::string::npos;
            });
            EXPECT_TRUE(is_expected) << call.first << ": " << line.part << ": " << line.reason;
        }
    }
}

TEST_F(PlanLines, DoNotContradictEachOther)
{
    for (const Arguments& how : {draft, ept, ppt, with(vpt, formula), with(with(stf, diffusion), formula),
                                 with(with(ept, {"--accuracy", "draft", "--grain-depth", "3"}), formula),
                                 with(ppt, {"--explicit-grains", "1"})}) {
        for (const auto& [name, keys] : scenes_) {
            if (name.starts_with("many") || name == "thin" || name == "pattern" || name == "library" ||
                name == "fill of a mixture")
                continue; // slow, and they add no new lines
            SCOPED_TRACE(fmt::format("{} {}", name, fmt::join(how, " ")));
            const std::vector<Line>&planned = run(name, with(how, plan_only)), &lines = run(name, how);
            const auto is_built = [&](const std::string& part) {
                const Line* line = find_line(lines, part);
                return line && line->built;
            };
            std::set<std::string> seen;
            for (const Line& line : lines) {
                EXPECT_TRUE(seen.insert(line.part).second) << line.part << " twice";
                EXPECT_FALSE(line.reason.empty()) << line.part;
                EXPECT_GE(line.seconds, 0) << line.part;
                EXPECT_GE(line.bytes, 0) << line.part;
                const std::string kind = line.kind();
                const bool of_memory = !std::set<std::string>{"explicit grains",
                                                              "proxies",
                                                              "surfaces inside grains",
                                                              "light sampling",
                                                              "walk in the packing",
                                                              "acceleration structure",
                                                              "shells of"}
                                            .contains(kind) &&
                                       !kind.starts_with("channels");
                if (!line.built) {
                    EXPECT_EQ(line.bytes, 0) << line.part;
                } else if (of_memory) {
                    EXPECT_GT(line.bytes, 0) << line.part;
                }
                if (line.built && (of_memory || kind == "shells of" || kind == "walk in the packing" ||
                                   kind == "acceleration structure")) {
                    EXPECT_GT(line.seconds, 0) << line.part;
                }
                if (line.built && kind == "exemplar") {
                    EXPECT_TRUE(is_built("explicit grains"));
                }
                if (line.built && kind == "walk in the packing") {
                    EXPECT_TRUE(is_built("medium of the grains"));
                }
                if (line.built && kind == "shells of") {
                    EXPECT_TRUE(is_built("distances within media"));
                }
                if (line.built && kind == "distances within media") {
                    EXPECT_TRUE(std::ranges::any_of(
                        lines, [](const Line& other) { return other.built && other.part.starts_with("medium "); }));
                }
                // Parts skipped by the plan are not built; planned parts are built unless only building could show why
                // not.
                const Line* before = find_line(planned, line.part);
                if (kind == "shells of") before = find_line(planned, "shells");
                ASSERT_TRUE(before) << line.part << " is not in the plan";
                if (line.built) {
                    EXPECT_TRUE(before->built) << line.part;
                } else if (before->built) {
                    EXPECT_THAT(before->reason, HasSubstr("to be ")) << line.part;
                }
            }
            if (name == "slab" || name == "thin slab" || name == "coloured slab") { // their boxes decide
                const auto of_slab = std::ranges::find(lines, "shells of", &Line::kind);
                EXPECT_EQ(find_line(planned, "shells")->built, of_slab != lines.end() && of_slab->built);
            }
            for (const Line& line : planned) {
                if (line.part != "shells") {
                    EXPECT_TRUE(seen.contains(line.part)) << line.part << " is in the plan only";
                }
            }
        }
    }
}

TEST_F(PlanLines, TenOpaqueGrainsNeedNothing)
{
    const auto parts = [&](const Arguments& how) {
        std::set<std::pair<std::string, bool>> all;
        for (const Line& line : run("ten", how)) all.insert({line.part, line.built});
        return all;
    };
    const auto automatic = parts({});
    for (const std::string& accuracy : accuracy_names.words()) EXPECT_EQ(parts({"--accuracy", accuracy}), automatic);
    EXPECT_EQ(parts(ept), automatic);
    std::set<std::string> built;
    for (const auto& [part, is_built] : automatic) {
        if (is_built) built.insert(part);
    }
    EXPECT_EQ(built, (std::set<std::string>{"acceleration structure", "explicit grains", "grains"}));
    EXPECT_TRUE(std::filesystem::is_empty(path("cache")));
}

TEST_F(PlanLines, StatisticsAreTextAsWell)
{
    const Arguments how{"--stats", "--integrator", "ppt", "--accuracy", "draft"};
    write("text.json", R"({"camera": {"origin": [0, -9, 5], "target": [0, 0, 0]}, "film": {"size": [8, 6]}, )" +
                           scenes_.at("ten on a floor") + "}");
    std::vector<std::string> arguments =
        with({"render", path("text.json"), "-q", "--spp", "1", "-o", path("out.exr")}, how);
    CLI::App app;
    add_render_command(app);
    std::ranges::reverse(arguments);
    testing::internal::CaptureStdout();
    app.parse(arguments);
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_THAT(text, testing::ContainsRegex("built +gsdf 'a' +traced, [^\n]+ \\([0-9.]+ k?M?B, [0-9.]+ s\\)"));
    EXPECT_THAT(text, testing::ContainsRegex("built +acceleration structure +Embree \\([0-9.]+ k?M?B, [0-9.]+ s\\)"));
    EXPECT_THAT(text, testing::ContainsRegex("built +surfaces inside grains +a second structure"));
    EXPECT_THAT(text, testing::ContainsRegex("skipped +exemplar 'a' +its shape"));
}

} // namespace
} // namespace scree
