// The error messages for a file that is not a mesh or is damaged.

#include "tests/ingest/mesh_files.h"

#include <limits>

using namespace scree;
using namespace scree::test;

TEST_F(MeshFiles, says_what_is_wrong_with_a_file)
{
    EXPECT_EQ(error_of(folder() / "none.obj"), "none.obj: found no such file, expected a mesh");
    std::filesystem::create_directory(folder() / "folder.obj");
    EXPECT_EQ(error_of(folder() / "folder.obj"), "folder.obj: found a directory, expected a mesh file");
    EXPECT_EQ(error_of("mesh.fbx", "x"), "mesh.fbx: found the extension '.fbx', expected .obj, .ply, .stl or .off");
    EXPECT_EQ(error_of("mesh", "x"), "mesh: found a name without extension, expected .obj, .ply, .stl or .off");
    for (const char* name : {"empty.obj", "empty.ply", "empty.stl", "empty.off"}) {
        EXPECT_EQ(error_of(name, ""), std::string(name) + ": found an empty file, expected a mesh");
    }
    EXPECT_EQ(error_of("wide.obj", std::string("\xff\xfev\0 \0", 6)),
              "wide.obj: found text in UTF-16, expected a binary file or text in ASCII or UTF-8");
}

TEST_F(MeshFiles, says_what_is_wrong_with_an_obj)
{
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_EQ(error_of("a.obj", vertices), "a.obj: found 3 vertices and no face, expected a mesh with faces");
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 4\n"),
              "a.obj:4: found a face with vertex 4, expected 1 to 3, as there are 3 vertices");
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 99999999999\n"),
              "a.obj:4: found a face with vertex 99999999999, expected 1 to 3, as there are 3 vertices");
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 0\n"),
              "a.obj:4: found a face with vertex 0, expected vertices counted from 1, or backwards from -1");
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 -4\n"),
              "a.obj:4: found a face with vertex -4, expected at most 3 vertices back: there are no more so far");
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 x 3\n"),
              "a.obj:4: found 'x', expected a whole number, a vertex of a face");
    EXPECT_EQ(error_of("a.obj", "v 0 0\n"), "a.obj:1: found nothing, expected a number, the z of a vertex");
    EXPECT_EQ(error_of("a.obj", "\n\nv 0 1,5 0\n"), "a.obj:3: found '1,5', expected a number, the y of a vertex");
    EXPECT_EQ(error_of("a.obj", "v 0 nan 0\nf 1 1 1\n"),
              "a.obj:1: found a vertex at (0, nan, 0), expected finite coordinates of at most 1e+100");
    EXPECT_EQ(error_of("a.obj", "v 0 0 1e400\nf 1 1 1\n"),
              "a.obj:1: found a vertex at (0, 0, inf), expected finite coordinates of at most 1e+100");
    EXPECT_EQ(error_of("a.obj", "v -1e101 0 0\nf 1 1 1\n"),
              "a.obj:1: found a vertex at (-1e+101, 0, 0), expected finite coordinates of at most 1e+100");
    EXPECT_EQ(error_of("a.obj", "{\"kind\": \"json\"}\n"),
              std::string("a.obj: found no line 'v x y z' and no line 'f a b c', expected a Wavefront OBJ mesh (") +
                  (folder() / "a.obj").string() + ":1 begins with '{\"kind\":')");
}

TEST_F(MeshFiles, says_what_is_wrong_with_an_off)
{
    EXPECT_EQ(error_of("a.off", "COFFEE\n"), "a.off:1: found 'COFFEE', expected 'OFF', the first word of an OFF mesh");
    EXPECT_EQ(error_of("a.off", "OFF\n3 x 0\n"), "a.off:2: found 'x', expected a whole number, the number of faces");
    EXPECT_EQ(error_of("a.off", "OFF\n3000000000 1 0\n0 0 0\n"),
              "a.off:2: found counts of 3000000000 vertices and 1 faces, expected counts that fit the 9 bytes after "
              "them (the file may be cut off)");
    EXPECT_EQ(error_of("a.off", "OFF\n-3 1 0\n0 0 0\n"),
              "a.off:2: found counts of -3 vertices and 1 faces, expected counts that fit the 9 bytes after them (the "
              "file may be cut off)");
    EXPECT_EQ(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
              "a.off:6: found a face with vertex 3, expected 0 to 2, as there are 3 vertices");
    EXPECT_EQ(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
              "a.off:6: found a face with vertex -1, expected 0 to 2, as there are 3 vertices");
    EXPECT_EQ(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n"),
              "a.off:6: found the end of the file after 0 faces, expected 1");
    EXPECT_EQ(error_of("a.off", "4OFF\n3 1 0\n1 0 0 0\n0 0 0 1\n0 1 0 1\n3 0 1 2\n").substr(0, 32),
              "a.off:3: found a vertex at (inf,");
    EXPECT_EQ(error_of("a.off", box_off_binary().substr(0, 155)),
              "a.off: found the end of the file in face 1, expected as much as its header announces");
}

TEST_F(MeshFiles, says_what_is_wrong_with_a_ply)
{
    const auto broken = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    EXPECT_EQ(error_of("a.ply", "plyx\n"), "a.ply:1: found 'plyx', expected 'ply', the first word of a PLY mesh");
    EXPECT_EQ(error_of("a.ply", "ply\nformat ascii 1.0\n"),
              "a.ply:3: found the end of the file, expected 'end_header'");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "ascii", "asci")),
              "a.ply:2: found format 'asci', expected 'ascii', 'binary_little_endian' or 'binary_big_endian'");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "double y", "double w")),
              "a.ply: found vertices without 'y', expected the properties x, y and z");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "uchar red", "colour red")),
              "a.ply:8: found 'colour', expected a PLY type: char, uchar, short, ushort, int, uint, float or double");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "element face", "element fact")),
              "a.ply: found a point cloud: no element 'face', expected a mesh with vertices and faces");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "4 3 2 1 0", "4 3 2 1 8")),
              "a.ply:20: found a face with vertex 8, expected 0 to 7, as there are 8 vertices");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "10 20 30", "10 inf 30")),
              "a.ply:12: found vertex 0 at (10, inf, 30), expected finite coordinates of at most 1e+100");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "face 6", "face 7")),
              "a.ply:26: found the end of the file in face 6, expected 7 of them, as the header says (the file may be "
              "cut off)");
    const std::string binary = box_ply_binary<int32_t>(std::endian::little, "int");
    EXPECT_EQ(
        error_of("a.ply", binary.substr(0, binary.size() - 1)),
        "a.ply: found the end of the file in face 5, expected 6 of them, as the header says (the file may be cut off)");
    EXPECT_EQ(error_of("a.ply", broken(binary, "vertex 8", "vertex 888888888888")),
              "a.ply: found the end of the file in vertex 12, expected 888888888888 of them, as the header says (the "
              "file may be cut off)");
}

TEST_F(MeshFiles, says_what_is_wrong_with_an_stl)
{
    const std::string text = box_stl(false), binary = box_stl_binary("");
    EXPECT_EQ(error_of("a.stl", "stolid\n"),
              "a.stl: found 7 bytes that do not begin with 'solid', expected an STL mesh, text or binary");
    EXPECT_EQ(error_of("a.stl", "solid x\nendsolid x\n"),
              "a.stl: found a mesh without vertices, expected vertices and faces");
    EXPECT_EQ(error_of("a.stl", text.substr(0, text.find("endsolid"))),
              "a.stl:86: found the end of the file, expected 'endsolid' (the file may be cut off)");
    EXPECT_EQ(error_of("a.stl", text.substr(0, text.find("endloop"))),
              "a.stl:7: found the end of the file in a facet, expected 'vertex x y z' or 'endfacet'");
    EXPECT_EQ(
        error_of("a.stl",
                 "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n"),
        "a.stl:7: found a facet of 2 vertices, expected three");
    EXPECT_EQ(error_of("a.stl", binary.substr(0, 300)),
              "a.stl: found 300 bytes and a count of 12 triangles, expected 684 bytes for them, or text that begins "
              "with 'solid' (the file may be cut off)");
    std::string nan = binary;
    nan.replace(84 + 50 + 12, 4, bytes(std::numeric_limits<float>::quiet_NaN(), std::endian::little));
    EXPECT_EQ(error_of("a.stl", nan),
              "a.stl: found a vertex of triangle 1 at (nan, 23, 30), expected finite coordinates of at most 1e+100");
}

TEST_F(MeshFiles, survives_every_cut_and_flipped_byte)
{
    const std::vector<std::pair<std::string, std::string>> files = {
        {"a.obj", box_obj([](uint32_t v) { return fmt::format("{}/1/1", v + 1); })},
        {"a.off", box_off()},
        {"b.off", box_off_binary()},
        {"a.ply", box_ply()},
        {"b.ply", box_ply_binary<int32_t>(std::endian::big, "int")},
        {"a.stl", box_stl(false)},
        {"b.stl", box_stl_binary("solid")}};
    for (const auto& [name, content] : files) {
        for (size_t i = 0; i < content.size(); i += 1 + content.size() / 100) {
            std::string flipped = content;
            flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
            for (const std::string& damaged : {content.substr(0, i), flipped}) {
                try {
                    report_mesh(read(name, damaged)); // a damaged file that is still a mesh may be read
                } catch (const InputError&) {
                }
            }
        }
    }
}
