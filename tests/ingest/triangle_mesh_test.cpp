// Meshes read from files of every format, and the reports about them.

#include "tests/ingest/mesh_files.h"

#include <cmath>

using namespace scree;
using namespace scree::test;

namespace {

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

/// The total area of the triangles.
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
    const TriangleMesh mesh =
        read("a.obj", "v 0.1234567890123456 1e-300 -9007199254740993e3\nv 1 0 0\nv 0 +1. .5\nf 1 2 3\n");
    EXPECT_EQ(mesh.positions[0], V3d(0.1234567890123456, 1e-300, -9007199254740993e3));
    EXPECT_EQ(mesh.positions[2], V3d(0, 1, 0.5));
}

TEST_F(MeshFiles, reads_triangle_strips)
{
    const TriangleMesh mesh = read(
        "strip.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                     "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                     "0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 2 1 3\n");
    ASSERT_EQ(mesh.triangles.size(), 3u);
    for (const auto& [a, b, c] : mesh.triangles) {
        EXPECT_GT((mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).z, 0);
    }
}

TEST_F(MeshFiles, triangulates_concave_polygons_inside_their_outline)
{
    // An arrow head, an L and a comb; along each axis and facing either way.
    const std::vector<std::vector<Imath::V2d>> outlines = {
        {{0, 0}, {4, -3}, {0, 5}, {-4, -3}},
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
                    const V3d normal =
                        (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
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
              "star.obj:6: found a face of 5 corners that crosses or overlaps itself, expected faces that do neither "
              "(export the mesh as triangles)");
}

TEST_F(MeshFiles, drops_faces_of_no_area)
{
    const std::string obj = box_obj([](uint32_t v) { return fmt::format("{}", v + 1); }) +
                            "v 11 20 30\nf 1 1 2\nf 1 2\nf 3\nf 1 9 2\nf 1 2 2 1 1\n";
    const TriangleMesh mesh = read("box.obj", obj);
    EXPECT_EQ(mesh.triangles.size(), 12u);
    EXPECT_EQ(error_of("line.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n"),
              "line.obj: found no face with an area, expected a mesh with faces");
}

TEST_F(MeshFiles, joins_the_vertices_of_a_seam_only_where_that_closes_the_surface)
{
    std::string apart, touching;
    uint32_t n = 0;
    for (const auto& face : box_faces) {
        for (const uint32_t c : face)
            apart += fmt::format("v {} {} {}\n", box_corners[c].x, box_corners[c].y, box_corners[c].z);
        apart += fmt::format("f {} {} {} {}\n", n + 1, n + 2, n + 3, n + 4);
        n += 4;
    }
    expect_box(read("apart.obj", apart));

    // Two boxes that touch along an edge: merged into one surface, they would not be closed.
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
    const std::vector<V3d> p = {{0, 0, 0}, {4, 0, 0},  {0, 4, 0},  {1, 1, -1}, {1, 1, 1},
                                {5, 5, 0}, {-1, 0, 0}, {0, -1, 0}, {1, 1, 0}};
    const auto count = [&](std::vector<std::array<uint32_t, 3>> triangles) {
        return report_mesh({p, std::move(triangles)}).self_intersections;
    };
    EXPECT_EQ(count({{0, 1, 2}, {3, 4, 5}}), 1u);
    EXPECT_EQ(count({{0, 1, 2}, {0, 6, 7}}), 0u);
    EXPECT_EQ(count({{0, 1, 2}, {0, 3, 4}}), 1u); // shares a vertex and pierces
    EXPECT_EQ(count({{0, 1, 2}, {1, 0, 7}}), 0u); // in the plane, on the other side of the edge
    EXPECT_EQ(count({{0, 1, 2}, {1, 0, 8}}), 1u); // on the same side
    EXPECT_EQ(count({{0, 1, 2}, {0, 1, 2}}), 1u);
    EXPECT_EQ(count({{0, 1, 2}, {2, 1, 0}}), 1u);

    // A corner of one box is inside another box: three faces of each box cross three faces of the other.
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
    // The second triangle ends one unit in the last place above the first, then on it, then below it.
    const auto touches = [](double z) {
        TriangleMesh mesh{{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {1, 1, z}, {2, 1, 3}, {1, 2, 3}}, {{0, 1, 2}, {3, 4, 5}}};
        return report_mesh(mesh).self_intersections == 1;
    };
    EXPECT_FALSE(touches(std::nextafter(1.0, 2.0)));
    EXPECT_TRUE(touches(1.0));
    EXPECT_TRUE(touches(std::nextafter(1.0, 0.0)));
}
