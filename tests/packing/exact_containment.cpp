#include "tests/packing/exact_containment.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Gmpq.h>
#include <CGAL/Interval_nt.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/squared_distance_3.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace scree {

namespace {

using Imath::V3d;
using Interval = CGAL::Interval_nt<false>;
using Filtered = CGAL::Exact_predicates_inexact_constructions_kernel;
using Rational = CGAL::Simple_cartesian<CGAL::Gmpq>;

struct IntervalVector {
    Interval x, y, z;
};

IntervalVector operator-(const IntervalVector& a, const IntervalVector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

Interval dot(const IntervalVector& a, const IntervalVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

IntervalVector cross(const IntervalVector& a, const IntervalVector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Interval square(const IntervalVector& a) { return CGAL::square(a.x) + CGAL::square(a.y) + CGAL::square(a.z); }

/// From the origin to the segment from a to b.
Interval squared_distance(const IntervalVector& a, const IntervalVector& b)
{
    const IntervalVector e = b - a;
    Interval t = -dot(a, e) / square(e);
    t = Interval(std::clamp(t.inf(), 0.0, 1.0), std::clamp(t.sup(), 0.0, 1.0));
    return square({a.x + t * e.x, a.y + t * e.y, a.z + t * e.z});
}

/// From the origin to the triangle.
Interval squared_distance(const IntervalVector& a, const IntervalVector& b, const IntervalVector& c)
{
    const Interval edges[3] = {squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)};
    Interval nearest(std::min({edges[0].inf(), edges[1].inf(), edges[2].inf()}),
                     std::min({edges[0].sup(), edges[1].sup(), edges[2].sup()}));
    const IntervalVector n = cross(b - a, c - a);
    const Interval sides[3] = {dot(cross(a, b), n), dot(cross(b, c), n), dot(cross(c, a), n)};
    if (std::ranges::any_of(sides, [](const Interval& s) { return s.sup() < 0; })) return nearest;
    const Interval plane = CGAL::square(dot(n, a)) / square(n);
    if (std::ranges::all_of(sides, [](const Interval& s) { return s.inf() > 0; })) return plane;
    return {std::min(nearest.inf(), plane.inf()), nearest.sup()};
}

IntervalVector from_to(const V3d& p, const V3d& q)
{
    return {Interval(q.x) - Interval(p.x), Interval(q.y) - Interval(p.y), Interval(q.z) - Interval(p.z)};
}

Rational::Point_3 rational(const V3d& p) { return {CGAL::Gmpq(p.x), CGAL::Gmpq(p.y), CGAL::Gmpq(p.z)}; }

CGAL::Gmpq exact_square(const V3d& p, const V3d& a, const V3d& b, const V3d& c)
{
    return CGAL::squared_distance(rational(p), Rational::Triangle_3(rational(a), rational(b), rational(c)));
}

} // namespace

int compare_distance(const V3d& point, const V3d& a, const V3d& b, const V3d& c, double distance)
{
    const CGAL::Gmpq limit(distance);
    return CGAL::compare(exact_square(point, a, b, c), limit * limit);
}

struct ExactSolid::Impl {
    const TriangleMesh mesh;
    std::vector<Imath::Box3d> boxes;
    double far = 0; ///< a few times the solid's size

    const V3d& corner(size_t face, size_t k) const { return mesh.positions[mesh.triangles[face][k]]; }

    /// Whether the box of a face is certainly farther than the radius.
    bool is_far(size_t face, const V3d& p, double radius) const
    {
        const auto& [lo, hi] = boxes[face];
        double square = 0;
        for (int k = 0; k < 3; ++k) {
            const double gap = std::max({lo[k] - p[k], p[k] - hi[k], 0.0});
            square += gap * gap;
        }
        return square * (1 - 1e-12) > radius * radius * (1 + 1e-12);
    }
};

ExactSolid::ExactSolid(const TriangleMesh& mesh) : impl_(new Impl{mesh, {}, 0})
{
    for (size_t face = 0; face < mesh.triangles.size(); ++face) {
        Imath::Box3d box;
        for (size_t k = 0; k < 3; ++k) box.extendBy(impl_->corner(face, k));
        impl_->boxes.push_back(box);
        for (int k = 0; k < 3; ++k)
            impl_->far = std::max({impl_->far, 16 * std::abs(box.min[k]), 16 * std::abs(box.max[k])});
    }
}

ExactSolid::~ExactSolid() = default;

bool ExactSolid::contains_sphere(const V3d& centre, double radius) const
{
    const Impl& s = *impl_;
    std::vector<size_t> unsure;
    {
        const Interval::Protector upward;
        const Interval limit = CGAL::square(Interval(radius));
        for (size_t face = 0; face < s.mesh.triangles.size(); ++face) {
            if (s.is_far(face, centre, radius)) continue;
            const Interval d = squared_distance(from_to(centre, s.corner(face, 0)), from_to(centre, s.corner(face, 1)),
                                                from_to(centre, s.corner(face, 2)));
            if (d.sup() < limit.inf()) return false;
            if (!(d.inf() >= limit.sup()) || !(d.inf() > 0)) unsure.push_back(face);
        }
    }
    const CGAL::Gmpq limit(radius);
    for (const size_t face : unsure) {
        const CGAL::Gmpq d = exact_square(centre, s.corner(face, 0), s.corner(face, 1), s.corner(face, 2));
        if (d < limit * limit || d == 0) return false;
    }
    return encloses(centre);
}

bool ExactSolid::encloses(const V3d& point) const
{
    const auto at = [](const V3d& p) { return Filtered::Point_3(p.x, p.y, p.z); };
    const Filtered::Point_3 p = at(point);
    for (int turn = 0;; ++turn) {
        // Far outside the solid, in a new direction each time.
        const V3d direction(std::cos(1.0 + turn), std::sin(1.0 + turn), 0.3 + 0.1 * turn);
        const Filtered::Point_3 q = at(point + direction * impl_->far);
        bool odd = false, clear = true;
        for (size_t face = 0; face < impl_->mesh.triangles.size() && clear; ++face) {
            const auto a = at(impl_->corner(face, 0)), b = at(impl_->corner(face, 1)), c = at(impl_->corner(face, 2));
            const CGAL::Sign from = CGAL::orientation(a, b, c, p), to = CGAL::orientation(a, b, c, q);
            if (from == to && from != CGAL::ZERO) continue;
            const CGAL::Sign ab = CGAL::orientation(p, q, a, b), bc = CGAL::orientation(p, q, b, c),
                             ca = CGAL::orientation(p, q, c, a);
            if (std::min({ab, bc, ca}) == CGAL::NEGATIVE && std::max({ab, bc, ca}) == CGAL::POSITIVE) continue;
            // The ray meets the triangle, one of its edges, or its plane only: the first case alone is clear.
            clear = ab != CGAL::ZERO && ab == bc && bc == ca && from != CGAL::ZERO && to != CGAL::ZERO;
            odd ^= clear;
        }
        if (clear) return odd;
    }
}

double ExactSolid::distance(const V3d& point) const
{
    const Impl& s = *impl_;
    double upper = HUGE_VAL;
    std::vector<std::pair<double, size_t>> lower;
    {
        const Interval::Protector upward;
        for (size_t face = 0; face < s.mesh.triangles.size(); ++face) {
            if (s.is_far(face, point, std::sqrt(upper))) continue;
            const Interval d = squared_distance(from_to(point, s.corner(face, 0)), from_to(point, s.corner(face, 1)),
                                                from_to(point, s.corner(face, 2)));
            upper = std::min(upper, d.sup());
            lower.emplace_back(d.inf(), face);
        }
    }
    CGAL::Gmpq least(upper);
    for (const auto& [bound, face] : lower)
        if (bound <= upper)
            least = std::min(least, exact_square(point, s.corner(face, 0), s.corner(face, 1), s.corner(face, 2)));
    return std::sqrt(CGAL::to_double(least));
}

} // namespace scree
