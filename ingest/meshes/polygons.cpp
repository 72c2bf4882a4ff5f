#include "ingest/meshes/polygons.h"

#include "base/cgal_messages.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <cmath>
#include <map>

namespace scree {

namespace {

using Imath::V3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point2 = Kernel::Point_2;

/// Whether a triangle of the plane lies inside the polygon; unknown: not yet reached.
enum class Side { unknown, outside, inside };

using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<uint32_t, Kernel>;
using FaceBase =
    CGAL::Constrained_triangulation_face_base_2<Kernel, CGAL::Triangulation_face_base_with_info_2<Side, Kernel>>;
// With this tag edges may touch and coincide, as they do where a polygon is cut open; if edges cross, CGAL throws.
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;
using Vertex = Triangulation::Vertex_handle;
using Face = Triangulation::Face_handle;
/// How often the polygon runs along an edge; if even, both sides of the edge are inside or both are outside.
using EdgeCount = std::map<std::pair<Vertex, Vertex>, int>;

/// Newell's normal, of length twice the area. Coordinates are relative to the first corner, so that small polygons far
/// from the origin keep their digits.
V3d normal_of(const std::vector<V3d>& positions, std::span<const uint32_t> corners)
{
    const V3d& origin = positions[corners[0]];
    V3d sum(0);
    for (size_t i = 1; i + 1 < corners.size(); ++i) {
        sum += (positions[corners[i]] - origin).cross(positions[corners[i + 1]] - origin);
    }
    return sum;
}

/// The corners projected along the axis nearest to the normal, counter-clockwise if the normal points at the viewer.
std::vector<Point2> flattened(const std::vector<V3d>& positions, std::span<const uint32_t> corners)
{
    const V3d normal = normal_of(positions, corners);
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
        if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
    }
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (normal[axis] < 0) std::swap(u, v);
    std::vector<Point2> points;
    for (const uint32_t corner : corners) points.emplace_back(positions[corner][u], positions[corner][v]);
    return points;
}

/// Splits along the diagonal for which the normals of the two halves agree better. In a concave quadrilateral this is
/// the diagonal inside it.
void split_quadrilateral(const std::vector<V3d>& positions, std::span<const uint32_t> c,
                         std::vector<std::array<uint32_t, 3>>& triangles)
{
    const auto normal = [&](int i, int j, int k) {
        const V3d& p = positions[c[static_cast<size_t>(i)]];
        return (positions[c[static_cast<size_t>(j)]] - p).cross(positions[c[static_cast<size_t>(k)]] - p);
    };
    const double along_02 = normal(0, 1, 2).dot(normal(0, 2, 3));
    const double along_13 = normal(0, 1, 3).dot(normal(1, 2, 3));
    if (along_02 >= along_13) {
        triangles.push_back({c[0], c[1], c[2]});
        triangles.push_back({c[0], c[2], c[3]});
    } else {
        triangles.push_back({c[0], c[1], c[3]});
        triangles.push_back({c[1], c[2], c[3]});
    }
}

bool is_strictly_convex(const std::vector<Point2>& p)
{
    const size_t n = p.size();
    int turns_back = 0; // how often the boundary changes its direction between right and left
    for (size_t i = 0; i < n; ++i) {
        const Point2 &a = p[i], &b = p[(i + 1) % n], &c = p[(i + 2) % n];
        if (CGAL::orientation(a, b, c) != CGAL::LEFT_TURN) return false;
        turns_back += CGAL::lexicographically_xy_smaller(a, b) != CGAL::lexicographically_xy_smaller(b, c);
    }
    return turns_back == 2;
}

/// Marks the triangles from the outside in. The side changes across an edge along which the polygon runs an odd number
/// of times. Returns false if two paths to a triangle disagree.
bool mark_sides(Triangulation& plane, const EdgeCount& edges)
{
    for (const Face face : plane.all_face_handles()) face->info() = Side::unknown;
    std::vector<Face> front{plane.infinite_face()};
    front.back()->info() = Side::outside;
    while (!front.empty()) {
        const Face face = front.back();
        front.pop_back();
        for (int i = 0; i < 3; ++i) {
            const Vertex a = face->vertex(Triangulation::cw(i)), b = face->vertex(Triangulation::ccw(i));
            const auto edge = edges.find(std::minmax(a, b));
            if (face->is_constrained(i) && edge == edges.end()) return false;
            const bool changes = edge != edges.end() && edge->second % 2 == 1;
            const Side side = (face->info() == Side::inside) != changes ? Side::inside : Side::outside;
            const Face next = face->neighbor(i);
            if (next->info() == Side::unknown) {
                next->info() = side;
                front.push_back(next);
            } else if (next->info() != side) {
                return false;
            }
        }
    }
    return true;
}

bool fill(const std::vector<Point2>& points, std::span<const uint32_t> corners,
          std::vector<std::array<uint32_t, 3>>& triangles)
{
    Triangulation plane;
    std::vector<Vertex> vertices;
    for (size_t i = 0; i < points.size(); ++i) {
        vertices.push_back(plane.insert(points[i]));
        vertices.back()->info() = corners[i];
    }
    EdgeCount edges;
    for (size_t i = 0; i < points.size(); ++i) {
        const Vertex a = vertices[i], b = vertices[(i + 1) % points.size()];
        if (a == b) return false;
        plane.insert_constraint(a, b);
        ++edges[std::minmax(a, b)];
    }
    if (plane.dimension() != 2 || !mark_sides(plane, edges)) return false;
    std::vector<std::array<uint32_t, 3>> found;
    for (const Face face : plane.finite_face_handles()) {
        if (face->info() == Side::inside) {
            found.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
        }
    }
    if (found.size() != corners.size() - 2) return false;
    triangles.insert(triangles.end(), found.begin(), found.end());
    return true;
}

} // namespace

bool has_area(const V3d& a, const V3d& b, const V3d& c)
{
    const auto point = [](const V3d& p) { return Kernel::Point_3(p.x, p.y, p.z); };
    return !CGAL::collinear(point(a), point(b), point(c));
}

bool triangulate_polygon(const std::vector<V3d>& positions, std::span<const uint32_t> corners,
                         std::vector<std::array<uint32_t, 3>>& triangles)
{
    if (corners.size() == 3) {
        triangles.push_back({corners[0], corners[1], corners[2]});
        return true;
    }
    if (corners.size() == 4) {
        split_quadrilateral(positions, corners, triangles);
        return true;
    }
    silence_cgal();
    const std::vector<Point2> points = flattened(positions, corners);
    if (is_strictly_convex(points)) {
        for (size_t i = 1; i + 1 < corners.size(); ++i) triangles.push_back({corners[0], corners[i], corners[i + 1]});
        return true;
    }
    try {
        return fill(points, corners, triangles);
    } catch (const std::exception&) { // CGAL: two constraints cross
        return false;
    }
}

} // namespace scree
