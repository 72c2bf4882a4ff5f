#include "ingest/cgal_messages.h"
#include "ingest/mesh_topology.h"
#include "ingest/triangle_mesh.h"
#include "ingest/weld.h"

#include <CGAL/Bbox_3.h>
#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

namespace scree {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, size_t, CGAL::Box_intersection_d::ID_FROM_BOX_ADDRESS>;

/// Triangles of exact predicates; vertices at one place count as one, so that seams are no intersections.
class ExactTriangles {
public:
    explicit ExactTriangles(const TriangleMesh& mesh) : mesh_(mesh), first_(first_at_same_position(mesh.positions)) {}

    CGAL::Bbox_3 bounds(size_t face) const
    {
        return point(face, 0).bbox() + point(face, 1).bbox() + point(face, 2).bbox();
    }

    /// Whether two faces meet elsewhere than at a shared vertex or edge.
    bool intersect(size_t f, size_t g) const
    {
        int shared = 0;
        size_t i = 0, j = 0; // corners of f and g at the same place
        for (size_t a = 0; a < 3; ++a) {
            for (size_t b = 0; b < 3; ++b) {
                if (vertex(f, a) != vertex(g, b)) continue;
                ++shared;
                // The sum of the shared corners' numbers tells the unshared one when two are shared.
                i += a;
                j += b;
            }
        }
        switch (shared) {
        case 0: return CGAL::do_intersect(triangle(f), triangle(g));
        case 1: return CGAL::do_intersect(triangle(f), opposite(g, j)) || CGAL::do_intersect(triangle(g), opposite(f, i));
        case 2: return folded_flat(f, 3 - i, g, 3 - j);
        default: return true; // the same face twice
        }
    }

private:
    uint32_t vertex(size_t face, size_t corner) const { return first_[mesh_.triangles[face][corner]]; }

    Point point(size_t face, size_t corner) const
    {
        const Imath::V3d& p = mesh_.positions[mesh_.triangles[face][corner]];
        return {p.x, p.y, p.z};
    }

    Kernel::Triangle_3 triangle(size_t face) const { return {point(face, 0), point(face, 1), point(face, 2)}; }

    Kernel::Segment_3 opposite(size_t face, size_t corner) const
    {
        return {point(face, (corner + 1) % 3), point(face, (corner + 2) % 3)};
    }

    /// Two faces at an edge overlap if they lie in one plane on the same side of the edge.
    bool folded_flat(size_t f, size_t apex_f, size_t g, size_t apex_g) const
    {
        const Point a = point(f, (apex_f + 1) % 3), b = point(f, (apex_f + 2) % 3);
        const Point p = point(f, apex_f), q = point(g, apex_g);
        return CGAL::coplanar(a, b, p, q) && CGAL::coplanar_orientation(a, b, p, q) == CGAL::POSITIVE;
    }

    const TriangleMesh& mesh_;
    std::vector<uint32_t> first_;
};

uint64_t count_self_intersections(const TriangleMesh& mesh)
{
    silence_cgal();
    const ExactTriangles triangles(mesh);
    std::vector<Box> boxes;
    boxes.reserve(mesh.triangles.size());
    for (size_t face = 0; face < mesh.triangles.size(); ++face) boxes.emplace_back(triangles.bounds(face), face);
    std::vector<const Box*> pointers;
    pointers.reserve(boxes.size());
    for (const Box& box : boxes) pointers.push_back(&box);

    uint64_t pairs = 0;
    const std::ptrdiff_t cutoff = 2000; // of CGAL's divide and conquer: its manual's advice for many boxes
    CGAL::box_self_intersection_d(
        pointers.begin(), pointers.end(),
        [&](const Box* a, const Box* b) { pairs += triangles.intersect(a->info(), b->info()); }, cutoff);
    return pairs;
}

} // namespace

MeshReport report_mesh(const TriangleMesh& mesh)
{
    MeshReport report;
    report.vertices = mesh.positions.size();
    report.faces = mesh.triangles.size();
    if (mesh.triangles.empty()) return report;
    const MeshTopology topology = topology_of(mesh);
    report.closed = topology.closed;
    report.oriented = topology.oriented;
    report.self_intersections = count_self_intersections(mesh);
    report.volume = signed_volume(mesh);
    const Imath::Box3d bounds = bounds_of(mesh);
    report.lo = bounds.min;
    report.hi = bounds.max;
    return report;
}

} // namespace scree
