#include "render/app/pack_command.h"

#include "ingest/particles/vdb_points.h"
#include "tests/builders/test_files.h"
#include "tests/packing/report_builders.h"

#include <CLI/CLI.hpp>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

namespace scree {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using Tree = boost::property_tree::ptree;

const std::string cube_off = "OFF\n8 12 0\n-1 -1 -1\n1 -1 -1\n1 1 -1\n-1 1 -1\n-1 -1 1\n1 -1 1\n1 1 1\n-1 1 1\n3 0 2 "
                             "1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n"
                             "3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";

size_t count_tags(const Tree& tree, const std::string& name)
{
    size_t count = 0;
    for (const auto& [key, child] : tree) count += (key == name) + count_tags(child, name);
    return count;
}

class ReportCommand : public testing::Test {
protected:
    std::string run(std::vector<std::string> words)
    {
        CLI::App app;
        CLI::App* pack = app.add_subcommand("pack");
        add_pack_report_command(*pack);
        words.insert(words.begin(), {"pack", "report"});
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

    /// A LAMMPS dump of the frame; not periodic if the frame has no box.
    std::string dump(const std::string& name, const ParticleFrame& frame,
                     const std::string& boundary = "pp pp pp") const
    {
        const Imath::V3d box =
            frame.box ? frame.box->edges[0] + frame.box->edges[1] + frame.box->edges[2] : Imath::V3d(100);
        std::string text = fmt::format("ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {}\n0 "
                                       "{:.17g}\n0 {:.17g}\n0 {:.17g}\nITEM: ATOMS id type x y z radius\n",
                                       frame.size(), boundary, box.x, box.y, box.z);
        for (size_t i = 0; i < frame.size(); ++i)
            text += fmt::format("{} 1 {:.17g} {:.17g} {:.17g} {}\n", frame.id[i], frame.position[i].x,
                                frame.position[i].y, frame.position[i].z, frame.radius[i]);
        return folder_.write(name, text);
    }
    json report(std::vector<std::string> words)
    {
        const std::string out = folder_.path("out.json").string();
        words.insert(words.end(), {"-q", "-o", out});
        EXPECT_EQ(run(words), "");
        return json::parse(test::read_bytes(out));
    }
    static std::string verdict(const json& report, const std::string& claim)
    {
        for (const json& c : report["claims"])
            if (c["claim"] == claim) return c["verdict"];
        return "";
    }

    test::TemporaryFolder folder_;
};

TEST_F(ReportCommand, HtmlIsWellFormedAndSelfContained)
{
    const std::string html = folder_.path("report.html").string(), numbers = folder_.path("numbers.txt").string();
    const std::string said = run({dump("a <&> b.dump", test::lattice("fcc", 4)), "-q", "-o", html, "--json", numbers});
    EXPECT_EQ(said, "");
    const std::string page = test::read_bytes(html);
    Tree tree;
    std::istringstream stream(page);
    boost::property_tree::read_xml(stream, tree); // throws if a tag is not closed
    EXPECT_EQ(count_tags(tree, "svg"), 2 * count_tags(tree, "figure"));
    EXPECT_GE(count_tags(tree, "figure"), 9u);
    EXPECT_EQ(count_tags(tree, "script"), 0u);
    for (const char* outside : {"href=", "src=", "url(", "@import"})
        EXPECT_EQ(page.find(outside), std::string::npos) << outside;
    EXPECT_THAT(page, HasSubstr("a &lt;&amp;&gt; b.dump"));
    EXPECT_EQ(page.find("nan"), std::string::npos);
    const json j = json::parse(test::read_bytes(numbers));
    EXPECT_EQ(j["spheres"], 256);
    EXPECT_NEAR(j["bond_order"]["global_q6"].get<double>(), 0.57452, 1e-5);
    EXPECT_EQ(verdict(j, "crystal"), "FAIL");
    EXPECT_NEAR(j["contacts"]["mean"].get<double>(), 12, 1e-9);
}

TEST_F(ReportCommand, VerdictsOnStandardOutput)
{
    const std::string said = run({dump("a.dump", test::lattice("sc", 4))});
    EXPECT_THAT(said, HasSubstr("PASS  fraction"));
    EXPECT_THAT(said, HasSubstr("FAIL  crystal"));
}

TEST_F(ReportCommand, TheSameTwice)
{
    const std::string file = dump("a.dump", test::lattice("hcp", 3));
    const json first = report({file}), second = report({file});
    EXPECT_EQ(first, second) << json::diff(first, second).dump().substr(0, 1000);
}

TEST_F(ReportCommand, OneSphere)
{
    const json periodic = report({dump("one.dump", test::periodic_frame({Imath::V3d(1)}, {0.5f}, Imath::V3d(4)))});
    EXPECT_EQ(verdict(periodic, "fraction"), "PASS");
    EXPECT_NEAR(periodic["fraction"]["by_volume"].get<double>(), M_PI / 6 / 64, 1e-9);
    const json alone =
        report({dump("alone.dump", test::periodic_frame({Imath::V3d(1)}, {0.5f}, Imath::V3d(4)), "ff ff ff")});
    EXPECT_EQ(verdict(alone, "fraction"), "INFO");
    EXPECT_EQ(alone["spheres"], 1);
}

TEST_F(ReportCommand, AWallAlongOneAxis)
{
    const json j = report({dump("bed.dump", test::lattice("fcc", 6), "pp pp ff")});
    EXPECT_THAT(j["container"].get<std::string>(), HasSubstr("bed"));
    EXPECT_EQ(verdict(j, "fraction"), "PASS");
    EXPECT_EQ(verdict(j, "chords"), "PASS");
}

TEST_F(ReportCommand, InAMesh)
{
    ParticleFrame frame = test::scaled(test::lattice("sc", 10, 0.495f), 0.2);
    for (Imath::V3d& p : frame.position) p -= Imath::V3d(0.9);
    frame.position[17].x += 0.05; // overlaps its neighbour, but stays in the cube
    frame.position[9].x = 0.95; // sticks out of the cube by 0.049
    const std::string mesh = folder_.write("cube.off", cube_off);
    const json j = report({dump("grid.dump", frame), "--mesh", mesh});
    EXPECT_EQ(verdict(j, "containment"), "FAIL");
    EXPECT_EQ(j["containment"]["outside"], 1);
    EXPECT_EQ(j["containment"]["worst"][0]["id"], 10);
    EXPECT_NEAR(j["containment"]["worst"][0]["margin"].get<double>(), 0.05 - 0.099, 1e-6);
    EXPECT_EQ(j["overlaps"]["worst"][0]["ids"], json({18, 19}));
    EXPECT_THAT(j["notes"].dump(), HasSubstr("periodic images are left out"));
}

TEST_F(ReportCommand, PointsOfOpenVdb)
{
    const ParticleFrame frame = test::lattice("bcc", 4);
    const std::string file = folder_.path("points.vdb").string();
    write_vdb_points(frame, file);
    const json j = report({file});
    EXPECT_EQ(j["spheres"], 128);
    EXPECT_EQ(verdict(j, "fraction"), "PASS");
    EXPECT_EQ(verdict(j, "overlap"), "PASS");
}

TEST_F(ReportCommand, FramesFromEitherEnd)
{
    const std::string two = test::read_bytes(dump("a.dump", test::lattice("sc", 2))) +
                            test::read_bytes(dump("b.dump", test::lattice("sc", 3)));
    const std::string file = folder_.write("two.dump", two);
    EXPECT_EQ(report({file})["spheres"], 27);
    EXPECT_EQ(report({file, "--frame", "0"})["spheres"], 8);
    EXPECT_EQ(report({file, "--frame", "-2"})["spheres"], 8);
    EXPECT_THROW(run({file, "--frame", "2"}), InputError);
    EXPECT_THROW(run({file, "--frame", "-3"}), InputError);
}

TEST_F(ReportCommand, RadiiThatAreNoneOrWrong)
{
    ParticleFrame frame = test::lattice("sc", 3);
    for (float& r : frame.radius) r = 0;
    EXPECT_THROW(run({dump("points.dump", frame)}), InputError);
    frame.radius[4] = 0.5f;
    const json j = report({dump("most.dump", frame)});
    EXPECT_EQ(j["spheres"], 1);
    EXPECT_THAT(j["notes"].dump(), HasSubstr("26 spheres of radius 0"));
    // Radii a hundred times too large: reported, and in reasonable time.
    for (float& r : frame.radius) r = 50;
    EXPECT_THROW(run({dump("huge.dump", frame)}), InputError);
    const json alone = report({dump("alone.dump", frame, "ff ff ff")});
    EXPECT_EQ(verdict(alone, "overlap"), "FAIL");
}

TEST_F(ReportCommand, BadInputLeavesNothingBehind)
{
    const std::string out = folder_.write("out.html", "as it was");
    const std::string empty = folder_.write(
        "empty.dump",
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\nITEM: BOX BOUNDS\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z radius\n");
    const std::string good = dump("good.dump", test::lattice("sc", 2));
    const std::string open_mesh = folder_.write("open.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    for (const std::vector<std::string>& words :
         std::vector<std::vector<std::string>>{{empty},
                                               {folder_.path("none.dump").string()},
                                               {folder_.write("no.vdb", "hello")},
                                               {good, "--mesh", open_mesh},
                                               {good, "--mesh", folder_.path("none.off").string()},
                                               {good, good}}) {
        std::vector<std::string> command = words;
        command.insert(command.end(), {"-q", "-o", out});
        EXPECT_THROW(run(command), InputError) << words[0];
        EXPECT_EQ(test::read_bytes(out), "as it was");
    }
    EXPECT_THROW(run({good, "-o", folder_.path("report.pdf").string()}), InputError);
    EXPECT_THROW(run({good, "-o", folder_.path("nowhere/report.html").string()}), InputError);
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
        EXPECT_EQ(entry.path().extension() == ".tmp", false);
}

} // namespace
} // namespace scree
