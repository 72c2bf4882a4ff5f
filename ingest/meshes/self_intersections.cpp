#include "ingest/meshes/self_intersections.h"

#include "base/cgal_messages.h"
#include "ingest/meshes/weld.h"

#include <CGAL/Bbox_3.h>
#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace scree {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box =
    CGAL::Box_intersection_d::Box_with_info_d<double, 3, uint32_t, CGAL::Box_intersection_d::ID_FROM_BOX_ADDRESS>;

/// Exact tests of the mesh's triangles; vertices at the same place count as one, so that seams are not intersections.
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
                // If two corners are shared, 3 minus the sum of their numbers is the number of the third corner.
                i += a;
                j += b;
            }
        }
        switch (shared) {
        case 0: return CGAL::do_intersect(triangle(f), triangle(g));
        case 1:
            return CGAL::do_intersect(triangle(f), opposite(g, j)) || CGAL::do_intersect(triangle(g), opposite(f, i));
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

/// Joins the results of two ranges of pairs.
SelfIntersections joined(const SelfIntersections& a, const SelfIntersections& b)
{
    if (a.pairs == 0) return b;
    if (b.pairs == 0) return a;
    SelfIntersections both = std::pair(a.first, a.second) < std::pair(b.first, b.second) ? a : b;
    both.pairs = a.pairs + b.pairs;
    return both;
}

/// Tests pairs whose boxes meet, many at a time on all threads.
class PairTester {
public:
    PairTester(const ExactTriangles& triangles, uint64_t enough) : triangles_(triangles), enough_(enough) {}

    /// Thrown by `add` when enough pairs were found.
    struct Enough {};

    void add(uint32_t f, uint32_t g)
    {
        waiting_.emplace_back(std::minmax(f, g));
        // Hostile meshes have as many pairs as the square of their faces, so the waiting list must be bounded.
        if (waiting_.size() < batch) return;
        test();
        if (found_.pairs >= enough_) throw Enough();
    }

    /// Tests what still waits.
    SelfIntersections finish()
    {
        test();
        return found_;
    }

private:
    static constexpr size_t batch = 1 << 18;

    void test()
    {
        const auto found = tbb::parallel_reduce(
            tbb::blocked_range<size_t>(0, waiting_.size(), 1024), SelfIntersections{},
            [&](const tbb::blocked_range<size_t>& range, SelfIntersections sum) {
                for (size_t k = range.begin(); k < range.end(); ++k) {
                    const auto [f, g] = waiting_[k];
                    if (triangles_.intersect(f, g)) sum = joined(sum, {1, f, g});
                }
                return sum;
            },
            joined);
        found_ = joined(found_, found);
        waiting_.clear();
    }

    const ExactTriangles& triangles_;
    uint64_t enough_;
    std::vector<std::pair<uint32_t, uint32_t>> waiting_;
    SelfIntersections found_;
};

} // namespace

SelfIntersections find_self_intersections(const TriangleMesh& mesh, uint64_t enough)
{
    silence_cgal();
    const ExactTriangles triangles(mesh);
    std::vector<Box> boxes;
    boxes.reserve(mesh.triangles.size());
    for (uint32_t face = 0; face < mesh.triangles.size(); ++face) boxes.emplace_back(triangles.bounds(face), face);
    std::vector<const Box*> pointers;
    pointers.reserve(boxes.size());
    for (const Box& box : boxes) pointers.push_back(&box);

    PairTester tester(triangles, enough);
    const std::ptrdiff_t cutoff = 2000; // for CGAL's divide and conquer; CGAL's manual advises it for many boxes
    try {
        CGAL::box_self_intersection_d(
            pointers.begin(), pointers.end(), [&](const Box* a, const Box* b) { tester.add(a->info(), b->info()); },
            cutoff);
    } catch (const PairTester::Enough&) { // the only way out of CGAL's loop
    }
    return tester.finish();
}

} // namespace scree
