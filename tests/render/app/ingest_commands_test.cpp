#include "ingest/particles/vdb_points.h"
#include "render/app/convert_command.h"
#include "render/app/info_command.h"
#include "tests/builders/test_files.h"

#include <CLI/CLI.hpp>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace scree {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string beads = "ITEM: UNITS\nsi\nITEM: TIME\n0.5\nITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX "
                          "BOUNDS pp pp ff\n0 4\n0 4\n0 4\n"
                          "ITEM: ATOMS id type x y z radius\n7 2 3 1 1 0.5\n5 1 1 1 1 0.5\n6 1 1 1 1.75 0.5\n";
const std::string bare = "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp ff\n0 4\n0 4\n0 "
                         "4\nITEM: ATOMS id type x y z\n1 1 1 1 1\n2 2 3 3 3\n";
const std::string tetrahedron = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

class IngestCommands : public testing::Test {
protected:
    /// What the command prints to standard output.
    std::string run(std::vector<std::string> words)
    {
        CLI::App app;
        add_info_command(app);
        add_convert_command(app);
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
    json info(std::vector<std::string> words)
    {
        words.insert(words.begin(), {"info", "--json"});
        return json::parse(run(words));
    }

    test::TemporaryFolder folder_;
};

TEST_F(IngestCommands, InfoOfADumpAsJson)
{
    const json d = info({folder_.write("a.dump", beads)});
    EXPECT_EQ(d["format"], "lammps");
    EXPECT_EQ(d["frames"], 1);
    EXPECT_EQ(d["particles"], json({3}));
    EXPECT_EQ(d["types"], json({{"1", 2}, {"2", 1}}));
    EXPECT_EQ(d["radius"], json({{"min", 0.5}, {"max", 0.5}, {"mean", 0.5}}));
    EXPECT_EQ(d["box"]["lo"], json({0.0, 0.0, 0.0}));
    EXPECT_EQ(d["box"]["periodic"], json({true, true, false}));
    EXPECT_NEAR(d["pack_rate"].get<double>(), 3 * 0.5235987755982989 / 64, 1e-12);
    EXPECT_NEAR(d["max_overlap"].get<double>(), 0.5, 1e-12);
    EXPECT_EQ(d["max_overlap_ids"], json({5, 6}));
    EXPECT_EQ(d["step"], 100);
    EXPECT_EQ(d["time"], 0.5);
    EXPECT_EQ(d["units"], "si");
    EXPECT_EQ(d["columns"], json({"id", "type", "x", "y", "z", "radius"}));
}

TEST_F(IngestCommands, InfoWithoutRadii)
{
    const std::string file = folder_.write("a.dump", bare);
    const json d = info({file});
    EXPECT_TRUE(d["radius"].is_null());
    EXPECT_TRUE(d["pack_rate"].is_null());
    EXPECT_TRUE(d["max_overlap"].is_null());
    EXPECT_THAT(d["notes"].dump(), HasSubstr("--radius"));
    EXPECT_EQ(info({file, "--radius", "0.25"})["radius"]["min"], 0.25);
    EXPECT_EQ(info({"--radius", "0.25", file})["radius"]["min"], 0.25);
    for (const std::vector<std::string>& words : {std::vector<std::string>{file, "--radius", "1=0.25", "2=0.5"},
                                                  {"--radius", "1=0.25,2=0.5", file},
                                                  {"--radius=1=0.25", "--radius", "2=0.5", file},
                                                  {"--radius", "1=0.25", "2=0.5", file}})
        EXPECT_EQ(info(words)["radius"]["max"], 0.5);
    EXPECT_THROW(info({file, "--radius", "1=0.25"}), InputError);
    EXPECT_THROW(info({file, "--radius", "small"}), InputError);
    EXPECT_THROW(info({file, "--radius", "-1"}), InputError);
}

TEST_F(IngestCommands, InfoOfSeveralFramesAndFiles)
{
    const std::string file = folder_.write("a.dump", beads + bare);
    const json d = info({file, "--frame", "1"});
    EXPECT_EQ(d["particles"], json({3, 2}));
    EXPECT_EQ(d["steps"], json({100, 200}));
    EXPECT_EQ(d["step"], 200);
    EXPECT_THROW(info({file, "--frame", "2"}), InputError);

    const auto lines = test::split_lines(run({"info", "--json", file, folder_.write("b.dump", bare)}));
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(json::parse(lines[1])["frames"], 1);
}

TEST_F(IngestCommands, InfoOfAMesh)
{
    const std::string file = folder_.write("a.off", tetrahedron);
    const json d = info({file});
    EXPECT_EQ(d["format"], "off");
    EXPECT_EQ(d["vertices"], 4);
    EXPECT_EQ(d["faces"], 4);
    EXPECT_EQ(d["closed"], true);
    EXPECT_EQ(d["oriented"], true);
    EXPECT_EQ(d["self_intersections"], 0);
    EXPECT_NEAR(d["volume"].get<double>(), 1.0 / 6, 1e-12);
    EXPECT_THAT(run({"info", file}), HasSubstr("volume        0.166667"));
}

TEST_F(IngestCommands, InfoForPeople)
{
    const std::string text = run({"info", folder_.write("a.dump", beads)});
    EXPECT_THAT(text, HasSubstr("LAMMPS dump, units si"));
    EXPECT_THAT(text, HasSubstr("1 pairs, up to 0.5 of the smaller radius (ids 5 and 6)"));
    EXPECT_THAT(run({"info", folder_.write("b.dump", bare)}), HasSubstr("note: no column of radii"));
}

TEST_F(IngestCommands, InfoOfAnEmptyFrame)
{
    const json d = info({folder_.write("a.dump", "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\nITEM: BOX BOUNDS\n0 "
                                                 "1\n0 1\n0 1\nITEM: ATOMS id x y z radius\n")});
    EXPECT_EQ(d["particles"], json({0}));
    EXPECT_TRUE(d["radius"].is_null());
    EXPECT_EQ(d["pack_rate"], 0.0);
}

TEST_F(IngestCommands, ConvertToCsv)
{
    const std::string out = folder_.path("out.csv").string();
    EXPECT_THAT(run({"convert", folder_.write("a.dump", beads), out}), HasSubstr("3 particles"));
    EXPECT_EQ(test::read_bytes(out), "id,type,x,y,z,radius\n5,1,1,1,1,0.5\n6,1,1,1,1.75,0.5\n7,2,3,1,1,0.5\n");
    run({"convert", folder_.write("b.dump", bare), out, "--radius", "1=0.1", "2=0.2"});
    EXPECT_EQ(test::read_bytes(out), "id,type,x,y,z,radius\n1,1,1,1,1,0.1\n2,2,3,3,3,0.2\n");
}

TEST_F(IngestCommands, ConvertLeavesNothingBehindWhenItFails)
{
    const std::string out = folder_.write("out.csv", "as it was");
    EXPECT_THROW(run({"convert", folder_.write("b.dump", bare), out}), InputError);
    EXPECT_EQ(test::read_bytes(out), "as it was");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
    EXPECT_THROW(run({"convert", folder_.write("a.dump", beads), folder_.path("out.txt").string()}), InputError);
    EXPECT_THROW(run({"convert", folder_.write("a.dump", beads)}), InputError);
}

TEST_F(IngestCommands, ConvertToVdbAndBack)
{
    // Grains far from the origin, with orientations, in a tilted box: all of this must read back.
    const std::string file =
        folder_.write("a.dump", "ITEM: TIME\n0.25\nITEM: TIMESTEP\n9\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS xy xz "
                                "yz pp ff pp\n9999990 10000020 2\n0 10 0\n0 10 0\n"
                                "ITEM: ATOMS id type x y z radius quatw quati quatj quatk\n"
                                "3 -4 10000000.001 1 2 0.5 1 0 0 0\n1 2 10000000.003 5 6 0.001 0.6 0.8 0 0\n2 7 "
                                "10000015 5 9 2 0.5 0.5 0.5 -0.5\n");
    const std::string out = folder_.path("out.vdb").string();
    run({"convert", file, out});
    const ParticleFrame frame = read_vdb_points(out);
    ASSERT_EQ(frame.size(), 3u);
    EXPECT_EQ(frame.id, (std::vector<uint64_t>{1, 2, 3}));
    EXPECT_EQ(frame.type, (std::vector<int32_t>{2, 7, -4}));
    EXPECT_EQ(frame.radius, (std::vector<float>{0.001f, 2, 0.5f}));
    EXPECT_NEAR(frame.position[0].x, 10000000.003, 1e-6);
    EXPECT_NEAR(frame.position[2].x, 10000000.001, 1e-6);
    EXPECT_NEAR(frame.position[1].z, 9, 1e-6);
    EXPECT_NEAR(frame.orientation[0].r, 0.6, 1e-6);
    EXPECT_NEAR(frame.orientation[0].v.x, 0.8, 1e-6);
    EXPECT_NEAR(frame.orientation[1].v.z, -0.5, 1e-6);
    EXPECT_EQ(frame.step, 9);
    EXPECT_EQ(frame.time, 0.25);
    ASSERT_TRUE(frame.box);
    EXPECT_EQ(frame.box->periodic, (std::array<bool, 3>{true, false, true}));
    EXPECT_EQ(frame.box->edges[1].x, 2);
    EXPECT_TRUE(frame.box->triclinic);

    const json d = info({out});
    EXPECT_EQ(d["format"], "vdb");
    EXPECT_EQ(d["particles"], json({3}));
}

TEST_F(IngestCommands, VdbOfAnEmptyFrameAndOfSizelessGrains)
{
    ParticleFrame frame;
    write_vdb_points(frame, folder_.path("empty.vdb"));
    EXPECT_EQ(read_vdb_points(folder_.path("empty.vdb")).size(), 0u);
    frame.position.assign(3, Imath::V3d(1, 2, 3));
    frame.radius.assign(3, 0.0f);
    frame.type.assign(3, 1);
    frame.id = {0, 1, 2};
    frame.origin = {1, 2, 3};
    write_vdb_points(frame, folder_.path("points.vdb"));
    const ParticleFrame found = read_vdb_points(folder_.path("points.vdb"));
    EXPECT_EQ(found.size(), 3u);
    EXPECT_FALSE(found.has_ids);
    EXPECT_NEAR(found.position[2].z, 3, 1e-6);
}

TEST_F(IngestCommands, VdbThatIsNone)
{
    EXPECT_THROW(read_vdb_points(folder_.write("a.vdb", "hello")), InputError);
    EXPECT_THROW(read_vdb_points(folder_.path("none.vdb")), InputError);
    EXPECT_THROW(run({"info", folder_.write("b.vdb", "")}), InputError);
}

} // namespace
} // namespace scree
