#include "ingest/triangle_mesh.h"

#include "ingest/support/error.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>

using namespace scree;
using Imath::V3d;

namespace {

/// A folder of the test's own, gone at its end.
class MeshFiles : public testing::Test {
protected:
    void SetUp() override
    {
        folder_ = std::filesystem::temp_directory_path() /
                  fmt::format("scree_mesh_{}_{}", getpid(), testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& name, const std::string& content) const
    {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    TriangleMesh read(const std::string& name, const std::string& content) const { return read_mesh(write(name, content)); }

    /// What the error says after the folder; fails the test if there is none.
    std::string error_of(const std::filesystem::path& path) const
    {
        try {
            read_mesh(path);
        } catch (const InputError& error) {
            const std::string text = error.what(), start = folder_.string() + "/";
            return text.starts_with(start) ? text.substr(start.size()) : text;
        }
        ADD_FAILURE() << path << " was read";
        return "";
    }
    std::string error_of(const std::string& name, const std::string& content) const { return error_of(write(name, content)); }

    const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
};

/// A box of 2 x 3 x 4 about a far point, as six quadrilaterals looking outward.
const std::vector<V3d> box_corners = {{10, 20, 30}, {12, 20, 30}, {12, 23, 30}, {10, 23, 30},
                                      {10, 20, 34}, {12, 20, 34}, {12, 23, 34}, {10, 23, 34}};
const std::vector<std::array<uint32_t, 4>> box_faces = {{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                        {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

std::string vertex_lines(const char* keyword)
{
    std::string text;
    for (const V3d& p : box_corners) text += fmt::format("{}{} {} {}\n", keyword, p.x, p.y, p.z);
    return text;
}

/// corner: how a vertex, counted from 0, is written.
std::string box_obj(const std::function<std::string(uint32_t)>& corner)
{
    std::string text = "# a box\nmtllib box.mtl\no box\n" + vertex_lines("v ") + "vt 0 0\nvn 0 0 1\nusemtl stone\ns off\ng sides\n";
    for (const auto& face : box_faces) {
        text += "f";
        for (const uint32_t vertex : face) text += fmt::format(" {}", corner(vertex));
        text += "\n";
    }
    return text;
}

std::string box_off()
{
    std::string text = "OFF\n# a box\n8 6 12\n" + vertex_lines("");
    for (const auto& [a, b, c, d] : box_faces) text += fmt::format("4  {} {} {} {}  0.5 0.5 0.5\n", a, b, c, d);
    return text;
}

template <typename T>
std::string bytes(T value, std::endian order)
{
    std::string raw(sizeof(T), '\0');
    std::memcpy(raw.data(), &value, sizeof(T));
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    return raw;
}

std::string box_off_binary()
{
    constexpr auto big = std::endian::big;
    std::string content = "OFF BINARY\n" + bytes(8, big) + bytes(6, big) + bytes(12, big);
    for (const V3d& p : box_corners) {
        for (int axis = 0; axis < 3; ++axis) content += bytes(static_cast<float>(p[axis]), big);
    }
    for (const auto& face : box_faces) {
        content += bytes(4, big);
        for (const uint32_t vertex : face) content += bytes(static_cast<int32_t>(vertex), big);
        content += bytes(3, big) + bytes(0.5f, big) + bytes(0.5f, big) + bytes(0.5f, big);
    }
    return content;
}

std::string box_ply_header(const char* format, const char* index_type)
{
    return fmt::format("ply\nformat {} 1.0\ncomment a box\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
                       "property uchar red\nelement face 6\nproperty list uchar {} vertex_indices\nend_header\n",
                       format, index_type);
}

std::string box_ply()
{
    std::string text = box_ply_header("ascii", "int");
    for (const V3d& p : box_corners) text += fmt::format("{} {} {} 255\n", p.x, p.y, p.z);
    for (const auto& [a, b, c, d] : box_faces) text += fmt::format("4 {} {} {} {}\n", a, b, c, d);
    return text;
}

template <typename Index>
std::string box_ply_binary(std::endian order, const char* index_type)
{
    std::string content = box_ply_header(order == std::endian::big ? "binary_big_endian" : "binary_little_endian", index_type);
    for (const V3d& p : box_corners) {
        for (int axis = 0; axis < 3; ++axis) content += bytes(p[axis], order);
        content += '\x7f';
    }
    for (const auto& face : box_faces) {
        content += '\4';
        for (const uint32_t vertex : face) content += bytes(static_cast<Index>(vertex), order);
    }
    return content;
}

std::string box_stl(bool upper)
{
    std::string text = "solid a box\n";
    for (const auto& face : box_faces) {
        for (const auto& corners : {std::array{face[0], face[1], face[2]}, std::array{face[0], face[2], face[3]}}) {
            text += " facet normal 0 0 0\n  outer loop\n";
            for (const uint32_t c : corners) {
                text += fmt::format("   vertex {} {} {}\n", box_corners[c].x, box_corners[c].y, box_corners[c].z);
            }
            text += "  endloop\n endfacet\n";
        }
    }
    text += "endsolid a box\n";
    if (upper) std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

std::string box_stl_binary(const std::string& title)
{
    constexpr auto little = std::endian::little;
    std::string content = title;
    content.resize(80);
    content += bytes(uint32_t{12}, little);
    for (const auto& face : box_faces) {
        for (const auto& corners : {std::array{face[0], face[1], face[2]}, std::array{face[0], face[2], face[3]}}) {
            for (int axis = 0; axis < 3; ++axis) content += bytes(0.0f, little);
            for (const uint32_t c : corners) {
                for (int axis = 0; axis < 3; ++axis) content += bytes(static_cast<float>(box_corners[c][axis]), little);
            }
            content += bytes(uint16_t{0}, little);
        }
    }
    return content;
}

void expect_box(const TriangleMesh& mesh)
{
    const MeshReport report = report_mesh(mesh);
    EXPECT_EQ(report.vertices, 8u);
    EXPECT_EQ(report.faces, 12u);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.oriented);
    EXPECT_EQ(report.self_intersections, 0u);
    EXPECT_DOUBLE_EQ(report.volume, 24);
    EXPECT_EQ(report.lo, box_corners[0]);
    EXPECT_EQ(report.hi, box_corners[6]);
    EXPECT_TRUE(is_closed_and_oriented(mesh));
}

TriangleMesh box_mesh()
{
    TriangleMesh mesh{box_corners, {}};
    for (const auto& [a, b, c, d] : box_faces) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    }
    return mesh;
}

/// Twice the area of all triangles, in the direction they look; of a flat polygon its area.
double area(const TriangleMesh& mesh)
{
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const V3d &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        sum += (q - p).cross(r - p).length() / 2;
    }
    return sum;
}

} // namespace

TEST_F(MeshFiles, reads_a_box_from_every_format)
{
    const std::vector<std::pair<std::string, std::string>> files = {
        {"plain.obj", box_obj([](uint32_t v) { return fmt::format("{}", v + 1); })},
        {"texture.obj", box_obj([](uint32_t v) { return fmt::format("{}/1", v + 1); })},
        {"normal.obj", box_obj([](uint32_t v) { return fmt::format("{}//1", v + 1); })},
        {"both.obj", box_obj([](uint32_t v) { return fmt::format("{}/1/1\t", v + 1); })},
        {"relative.obj", box_obj([](uint32_t v) { return fmt::format("{}", static_cast<int>(v) - 8); })},
        {"continued.OBJ", box_obj([](uint32_t v) { return fmt::format("{} \\\n", v + 1); })},
        {"text.off", box_off()},
        {"binary.off", box_off_binary()},
        {"bare.off", box_off().substr(4)},
        {"text.ply", box_ply()},
        {"little.ply", box_ply_binary<int32_t>(std::endian::little, "int")},
        {"big.ply", box_ply_binary<uint32_t>(std::endian::big, "uint32")},
        {"short.ply", box_ply_binary<uint16_t>(std::endian::little, "ushort")},
        {"byte.ply", box_ply_binary<uint8_t>(std::endian::big, "uint8")},
        {"text.stl", box_stl(false)},
        {"upper.STL", box_stl(true)},
        {"binary.stl", box_stl_binary("made by a test")},
        {"solid.stl", box_stl_binary("solid but binary")},
        {"trailing.stl", box_stl_binary("made by a test") + "more"},
        {"bom.obj", "\xef\xbb\xbf" + box_obj([](uint32_t v) { return fmt::format("{}", v + 1); })},
    };
    for (const auto& [name, content] : files) {
        SCOPED_TRACE(name);
        expect_box(read(name, content));
        if (content.find('\0') == std::string::npos && name != "continued.OBJ") { // text: other line ends too
            std::string crlf;
            for (const char c : content) crlf += c == '\n' ? "\r\n" : std::string(1, c);
            expect_box(read("crlf_" + name, crlf));
        }
    }
}

TEST_F(MeshFiles, keeps_every_digit_of_a_double)
{
    const TriangleMesh mesh = read("a.obj", "v 0.1234567890123456 1e-300 -9007199254740993e3\nv 1 0 0\nv 0 +1. .5\nf 1 2 3\n");
    EXPECT_EQ(mesh.positions[0], V3d(0.1234567890123456, 1e-300, -9007199254740993e3));
    EXPECT_EQ(mesh.positions[2], V3d(0, 1, 0.5));
}

TEST_F(MeshFiles, reads_triangle_strips)
{
    const TriangleMesh mesh = read("strip.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                                                "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                                                "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 2 1 3\n");
    ASSERT_EQ(mesh.triangles.size(), 3u);
    for (const auto& [a, b, c] : mesh.triangles) {
        EXPECT_GT((mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).z, 0);
    }
}

TEST_F(MeshFiles, triangulates_concave_polygons_inside_their_outline)
{
    // An arrow head, an L and a comb; along each axis and looking either way.
    const std::vector<std::vector<Imath::V2d>> outlines = {{{0, 0}, {4, -3}, {0, 5}, {-4, -3}},
                                                           {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}},
                                                           {{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {4, 1}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}};
    const std::vector<double> areas = {20, 4, 13};
    for (size_t k = 0; k < outlines.size(); ++k) {
        for (int axis = 0; axis < 3; ++axis) {
            for (const bool turned : {false, true}) {
                SCOPED_TRACE(fmt::format("outline {} axis {} turned {}", k, axis, turned));
                std::vector<Imath::V2d> outline = outlines[k];
                if (turned) std::reverse(outline.begin(), outline.end());
                std::string obj, face = "f";
                for (size_t i = 0; i < outline.size(); ++i) {
                    V3d p(0);
                    p[(axis + 1) % 3] = outline[i].x;
                    p[(axis + 2) % 3] = outline[i].y;
                    p[axis] = 0.25 * p[(axis + 1) % 3];
                    obj += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
                    face += fmt::format(" {}", i + 1);
                }
                const TriangleMesh mesh = read("outline.obj", obj + face + "\n");
                EXPECT_EQ(mesh.triangles.size(), outline.size() - 2);
                EXPECT_NEAR(area(mesh), areas[k] * std::sqrt(1 + 0.25 * 0.25), 1e-12);
                for (const auto& [a, b, c] : mesh.triangles) {
                    const V3d normal = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
                    EXPECT_GT(turned ? -normal[axis] : normal[axis], 0);
                }
                EXPECT_EQ(report_mesh(mesh).self_intersections, 0u);
            }
        }
    }
}

TEST_F(MeshFiles, triangulates_a_polygon_cut_open_for_its_hole)
{
    const std::string obj = "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\n"
                            "f 1 2 3 4 1 5 6 7 8 5\n";
    const TriangleMesh mesh = read("ring.obj", obj);
    EXPECT_EQ(mesh.triangles.size(), 8u);
    EXPECT_DOUBLE_EQ(area(mesh), 8);
    EXPECT_EQ(report_mesh(mesh).self_intersections, 0u);
}

TEST_F(MeshFiles, refuses_a_polygon_that_crosses_itself)
{
    const std::string star = "v 0 3 0\nv 2 -3 0\nv -3 1 0\nv 3 1 0\nv -2 -3 0\n";
    EXPECT_EQ(error_of("star.obj", star + "f 1 2 3 4 5\n"),
              "star.obj:6: found a face of 5 corners that crosses or overlaps itself, expected faces that do not (export the mesh as triangles)");
}

TEST_F(MeshFiles, drops_faces_of_no_area)
{
    const std::string obj = box_obj([](uint32_t v) { return fmt::format("{}", v + 1); }) +
                            "v 11 20 30\nf 1 1 2\nf 1 2\nf 3\nf 1 9 2\nf 1 2 2 1 1\n";
    const TriangleMesh mesh = read("box.obj", obj);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(error_of("line.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n"), "line.obj: found no face with an area, expected a mesh with faces");
}

TEST_F(MeshFiles, joins_the_vertices_of_a_seam_only_where_that_closes_the_surface)
{
    std::string apart, touching;
    uint32_t n = 0;
    for (const auto& face : box_faces) {
        for (const uint32_t c : face) apart += fmt::format("v {} {} {}\n", box_corners[c].x, box_corners[c].y, box_corners[c].z);
        apart += fmt::format("f {} {} {} {}\n", n + 1, n + 2, n + 3, n + 4);
        n += 4;
    }
    expect_box(read("apart.obj", apart));

    // Two boxes that touch along an edge: as one surface it would not be closed.
    touching = box_obj([](uint32_t v) { return fmt::format("{}", static_cast<int>(v) - 8); });
    for (const V3d& p : box_corners) touching += fmt::format("v {} {} {}\n", p.x + 2, p.y + 3, p.z);
    for (const auto& [a, b, c, d] : box_faces) touching += fmt::format("f {} {} {} {}\n", a + 9, b + 9, c + 9, d + 9);
    const TriangleMesh two = read("touching.obj", touching);
    EXPECT_EQ(two.positions.size(), 16u);
    EXPECT_TRUE(is_closed_and_oriented(two));
    EXPECT_DOUBLE_EQ(signed_volume(two), 48);
}

TEST(TriangleMesh, tells_open_flipped_and_inverted_surfaces)
{
    TriangleMesh mesh = box_mesh();
    mesh.triangles.pop_back();
    MeshReport report = report_mesh(mesh);
    EXPECT_FALSE(report.closed);
    EXPECT_TRUE(report.oriented);
    EXPECT_FALSE(is_closed_and_oriented(mesh));

    mesh = box_mesh();
    std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
    report = report_mesh(mesh);
    EXPECT_TRUE(report.closed);
    EXPECT_FALSE(report.oriented);
    EXPECT_FALSE(is_closed_and_oriented(mesh));

    mesh = box_mesh();
    for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
    report = report_mesh(mesh);
    EXPECT_TRUE(report.closed && report.oriented);
    EXPECT_DOUBLE_EQ(report.volume, -24);

    mesh = box_mesh();
    mesh.triangles.push_back(mesh.triangles[0]); // an edge with three faces
    EXPECT_FALSE(report_mesh(mesh).closed);

    report = report_mesh(TriangleMesh{});
    EXPECT_FALSE(report.closed);
    EXPECT_EQ(report.volume, 0);
}

TEST(TriangleMesh, volume_keeps_its_digits_far_from_the_origin_and_scales_exactly)
{
    TriangleMesh mesh = box_mesh();
    for (V3d& p : mesh.positions) p += V3d(1e9, -1e9, 1e9);
    EXPECT_DOUBLE_EQ(signed_volume(mesh), 24);
    for (V3d& p : mesh.positions) p *= std::ldexp(1.0, -60);
    EXPECT_EQ(signed_volume(mesh), std::ldexp(24.0, -180));
}

TEST(TriangleMesh, counts_pairs_of_faces_that_meet_elsewhere)
{
    // A triangle that pierces another; one that only shares a vertex; one folded flat on its neighbour; the same twice.
    const std::vector<V3d> p = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {5, 5, 0}, {-1, 0, 0}, {0, -1, 0}, {1, 1, 0}};
    const auto count = [&](std::vector<std::array<uint32_t, 3>> triangles) { return report_mesh({p, std::move(triangles)}).self_intersections; };
    EXPECT_EQ(count({{0, 1, 2}, {3, 4, 5}}), 1u);
    EXPECT_EQ(count({{0, 1, 2}, {0, 6, 7}}), 0u);
    EXPECT_EQ(count({{0, 1, 2}, {0, 3, 4}}), 1u); // shares a vertex and pierces
    EXPECT_EQ(count({{0, 1, 2}, {1, 0, 7}}), 0u); // in the plane, on the other side of the edge
    EXPECT_EQ(count({{0, 1, 2}, {1, 0, 8}}), 1u); // on the same side
    EXPECT_EQ(count({{0, 1, 2}, {0, 1, 2}}), 1u);
    EXPECT_EQ(count({{0, 1, 2}, {2, 1, 0}}), 1u);

    // Two boxes of which one reaches into the other by its corner: three faces of each cross three of the other.
    TriangleMesh mesh = box_mesh();
    for (const V3d& corner : box_corners) mesh.positions.push_back(corner + V3d(1.25, 1.5, 2.75));
    for (const auto& [a, b, c] : box_mesh().triangles) mesh.triangles.push_back({a + 8, b + 8, c + 8});
    const MeshReport report = report_mesh(mesh);
    EXPECT_TRUE(report.closed && report.oriented);
    EXPECT_GE(report.self_intersections, 6u);
    EXPECT_DOUBLE_EQ(report.volume, 48);
}

TEST(TriangleMesh, intersections_are_exact)
{
    // The second triangle stands one unit in the last place above the first, then on it, then through it.
    const auto touches = [](double z) {
        TriangleMesh mesh{{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {1, 1, z}, {2, 1, 3}, {1, 2, 3}}, {{0, 1, 2}, {3, 4, 5}}};
        return report_mesh(mesh).self_intersections == 1;
    };
    EXPECT_FALSE(touches(std::nextafter(1.0, 2.0)));
    EXPECT_TRUE(touches(1.0));
    EXPECT_TRUE(touches(std::nextafter(1.0, 0.0)));
}

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
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 4\n"), "a.obj:4: found a face with vertex 4, expected 1 to 3, as there are 3 vertices");
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 99999999999\n"),
              "a.obj:4: found a face with vertex 99999999999, expected 1 to 3, as there are 3 vertices");
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 0\n"),
              "a.obj:4: found a face with vertex 0, expected vertices counted from 1, or from -1 back");
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 -4\n"),
              "a.obj:4: found a face with vertex -4, expected at most 3 vertices back, as there are no more so far");
    EXPECT_EQ(error_of("a.obj", vertices + "f 1 2 x 3\n"), "a.obj:4: found 'x', expected a whole number, a vertex of a face");
    EXPECT_EQ(error_of("a.obj", "v 0 0\n"), "a.obj:1: found nothing, expected a number, the z of a vertex");
    EXPECT_EQ(error_of("a.obj", "\n\nv 0 1,5 0\n"), "a.obj:3: found '1,5', expected a number, the y of a vertex");
    EXPECT_EQ(error_of("a.obj", "v 0 nan 0\nf 1 1 1\n"), "a.obj:1: found a vertex at (0, nan, 0), expected finite coordinates of at most 1e+100");
    EXPECT_EQ(error_of("a.obj", "v 0 0 1e400\nf 1 1 1\n"), "a.obj:1: found a vertex at (0, 0, inf), expected finite coordinates of at most 1e+100");
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
              "a.off:2: found counts of 3000000000 vertices and 1 faces, expected counts that fit the 9 bytes after them (the file may be cut off)");
    EXPECT_EQ(error_of("a.off", "OFF\n-3 1 0\n0 0 0\n"),
              "a.off:2: found counts of -3 vertices and 1 faces, expected counts that fit the 9 bytes after them (the file may be cut off)");
    EXPECT_EQ(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
              "a.off:6: found a face with vertex 3, expected 0 to 2, as there are 3 vertices");
    EXPECT_EQ(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n"),
              "a.off:6: found a face with vertex -1, expected 0 to 2, as there are 3 vertices");
    EXPECT_EQ(error_of("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n"), "a.off:6: found the end of the file after 0 faces, expected 1");
    EXPECT_EQ(error_of("a.off", "4OFF\n3 1 0\n1 0 0 0\n0 0 0 1\n0 1 0 1\n3 0 1 2\n").substr(0, 32), "a.off:3: found a vertex at (inf,");
    EXPECT_EQ(error_of("a.off", box_off_binary().substr(0, 155)),
              "a.off: found the end of the file in face 1, expected as much as its header announces");
}

TEST_F(MeshFiles, says_what_is_wrong_with_a_ply)
{
    const auto broken = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    EXPECT_EQ(error_of("a.ply", "plyx\n"), "a.ply:1: found 'plyx', expected 'ply', the first word of a PLY mesh");
    EXPECT_EQ(error_of("a.ply", "ply\nformat ascii 1.0\n"), "a.ply:3: found the end of the file, expected 'end_header'");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "ascii", "asci")),
              "a.ply:2: found format 'asci', expected 'ascii', 'binary_little_endian' or 'binary_big_endian'");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "double y", "double w")), "a.ply: found vertices without 'y', expected the properties x, y and z");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "uchar red", "colour red")),
              "a.ply:8: found 'colour', expected a PLY type: char, uchar, short, ushort, int, uint, float or double");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "element face", "element fact")),
              "a.ply: found a point cloud: no element 'face', expected a mesh with vertices and faces");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "4 3 2 1 0", "4 3 2 1 8")),
              "a.ply:20: found a face with vertex 8, expected 0 to 7, as there are 8 vertices");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "10 20 30", "10 inf 30")),
              "a.ply:12: found vertex 0 at (10, inf, 30), expected finite coordinates of at most 1e+100");
    EXPECT_EQ(error_of("a.ply", broken(box_ply(), "face 6", "face 7")),
              "a.ply:26: found the end of the file in face 6, expected 7 of them, as the header says (the file may be cut off)");
    const std::string binary = box_ply_binary<int32_t>(std::endian::little, "int");
    EXPECT_EQ(error_of("a.ply", binary.substr(0, binary.size() - 1)),
              "a.ply: found the end of the file in face 5, expected 6 of them, as the header says (the file may be cut off)");
    EXPECT_EQ(error_of("a.ply", broken(binary, "vertex 8", "vertex 888888888888")),
              "a.ply: found the end of the file in vertex 12, expected 888888888888 of them, as the header says (the file may be cut off)");
}

TEST_F(MeshFiles, says_what_is_wrong_with_an_stl)
{
    const std::string text = box_stl(false), binary = box_stl_binary("");
    EXPECT_EQ(error_of("a.stl", "stolid\n"), "a.stl: found 7 bytes that do not begin with 'solid', expected an STL mesh, text or binary");
    EXPECT_EQ(error_of("a.stl", "solid x\nendsolid x\n"), "a.stl: found a mesh without vertices, expected vertices and faces");
    EXPECT_EQ(error_of("a.stl", text.substr(0, text.find("endsolid"))),
              "a.stl:86: found the end of the file, expected 'endsolid' (the file may be cut off)");
    EXPECT_EQ(error_of("a.stl", text.substr(0, text.find("endloop"))),
              "a.stl:7: found the end of the file in a facet, expected 'vertex x y z' or 'endfacet'");
    EXPECT_EQ(error_of("a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n"),
              "a.stl:7: found a facet of 2 vertices, expected three");
    EXPECT_EQ(error_of("a.stl", binary.substr(0, 300)),
              "a.stl: found 300 bytes and a count of 12 triangles, expected 684 bytes for them, or text that begins with 'solid' (the file may be cut off)");
    std::string nan = binary;
    nan.replace(84 + 50 + 12, 4, bytes(std::numeric_limits<float>::quiet_NaN(), std::endian::little));
    EXPECT_EQ(error_of("a.stl", nan), "a.stl: found a vertex of triangle 1 at (nan, 23, 30), expected finite coordinates of at most 1e+100");
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
                    report_mesh(read(name, damaged)); // whatever is still a mesh may be read
                } catch (const InputError&) {
                }
            }
        }
    }
}
