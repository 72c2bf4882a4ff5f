#include "packing/solids/exact_distance.h"

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

using Imath::V3d;
using Exact = CGAL::Exact_rational;

/// A point of a triangle that is nearly its nearest to the origin, and a direction along which no other is nearer.
struct Witness {
    V3d nearest, direction;
};

/// Ericson, Real-Time Collision Detection (2005), 5.1.5: the Voronoi regions of corners, edges and face. Rounding may
/// choose the wrong region near a border; the proof of the bounds does not depend on the choice.
Witness nearest_witness(const V3d& a, const V3d& b, const V3d& c)
{
    const V3d ab = b - a, ac = c - a;
    const double d1 = -ab.dot(a), d2 = -ac.dot(a);
    if (d1 <= 0 && d2 <= 0) return {a, a};
    const double d3 = -ab.dot(b), d4 = -ac.dot(b);
    if (d3 >= 0 && d4 <= d3) return {b, b};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const V3d p = a + ab * (d1 / (d1 - d3));
        return {p, p};
    }
    const double d5 = -ab.dot(c), d6 = -ac.dot(c);
    if (d6 >= 0 && d5 <= d6) return {c, c};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const V3d p = a + ac * (d2 / (d2 - d6));
        return {p, p};
    }
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const V3d p = b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
        return {p, p};
    }
    // Rounding can bring an outside point here; the weights must still be those of a point of the triangle.
    const double wb = std::max(vb, 0.0), wc = std::max(vc, 0.0), sum = std::max(va, 0.0) + wb + wc;
    if (!(sum > 0)) return {a, a};
    const V3d p = a + ab * (wb / sum) + ac * (wc / sum);
    const V3d normal = ab.cross(ac);
    return {p, normal.dot(a) >= 0 ? normal : -normal};
}

double largest(const V3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

} // namespace

DistanceBounds bound_distance(const V3d& point, const Corners& triangle, double scale)
{
    const V3d a = (triangle[0] - point) * scale, b = (triangle[1] - point) * scale, c = (triangle[2] - point) * scale;
    const Witness w = nearest_witness(a, b, c);
    const double farthest = std::max({largest(a), largest(b), largest(c)});

    // Let u = 2^-53 and M = farthest; each component of a, b, c is within u M of the truth.
    //
    // Upper bound: the exact a + s (b - a) + t (c - a) with the computed s, t >= 0, s + t <= 1 + 2u, is within 4 u
    // M of a point of the triangle. What was computed for it is within 13 u M in each component (u M of a, 6 u M
    // weighted by s + t for the two products and what they are made of, u M for each sum), 17 sqrt(3) u M < 30 u M in
    // length; the root and the three squares under it add 2.5 u sqrt(3) M, and the last sum 2 u M. Together below 40 u
    // M.
    //
    // Lower bound: for any direction n the triangle is no nearer than min n.v / |n| over its corners v. A computed n.v
    // is within 4 u M (|n_x| + |n_y| + |n_z|) <= 7 u M |n|; root, division and difference add 5 u sqrt(3) M. Together
    // below 40 u M.
    //
    // Underflow: squares of numbers below 2^-500 may vanish, so no shorter distance is claimed and no shorter direction
    // is used; a product then loses less than 2^-570.
    const double error = farthest * (40 * 0x1p-53) + 0x1p-498;
    DistanceBounds bounds{0, std::sqrt(w.nearest.dot(w.nearest)) + error};
    if (largest(w.direction) >= 0x1p-500) {
        const double length = std::sqrt(w.direction.dot(w.direction));
        const double support = std::min({w.direction.dot(a), w.direction.dot(b), w.direction.dot(c)});
        bounds.lo = std::max(0.0, support / length - error);
    }
    // NaN (from overflow or a triangle without area) gives no bound.
    if (!(bounds.lo >= 0)) bounds.lo = 0;
    if (!(bounds.hi >= 0)) bounds.hi = HUGE_VAL;
    return bounds;
}

namespace {

struct ExactVector {
    Exact x, y, z;
};

ExactVector difference(const V3d& a, const V3d& b)
{
    return {Exact(a.x) - Exact(b.x), Exact(a.y) - Exact(b.y), Exact(a.z) - Exact(b.z)};
}

ExactVector difference(const ExactVector& a, const ExactVector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

Exact dot(const ExactVector& a, const ExactVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ExactVector cross(const ExactVector& a, const ExactVector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Squared distance from the origin to the segment a to b.
Exact squared_distance_to_segment(const ExactVector& a, const ExactVector& b)
{
    const ExactVector along = difference(b, a);
    const Exact t = -dot(a, along), length = dot(along, along);
    if (t <= 0) return dot(a, a);
    if (t >= length) return dot(b, b);
    return dot(a, a) - t * t / length;
}

Exact squared_distance(const V3d& point, const Corners& triangle)
{
    const ExactVector v[3] = {difference(triangle[0], point), difference(triangle[1], point),
                              difference(triangle[2], point)};
    const ExactVector normal = cross(difference(v[1], v[0]), difference(v[2], v[0]));
    bool above = true;
    Exact nearest = dot(v[0], v[0]);
    for (int k = 0; k < 3; ++k) {
        const ExactVector &a = v[k], &b = v[(k + 1) % 3];
        nearest = std::min(nearest, squared_distance_to_segment(a, b));
        // The foot of the perpendicular from the origin to the plane must be on the triangle's side of this edge.
        if (dot(cross(normal, difference(b, a)), a) > 0) above = false;
    }
    const Exact area = dot(normal, normal);
    if (!above || area == 0) return nearest;
    const Exact height = dot(normal, v[0]);
    return height * height / area;
}

} // namespace

bool is_nearer_exactly(const V3d& point, const Corners& triangle, double distance)
{
    const Exact limit(distance);
    return squared_distance(point, triangle) < limit * limit;
}

bool touches_exactly(const V3d& point, const Corners& triangle) { return squared_distance(point, triangle) == 0; }

double distance_exactly(const V3d& point, const Corners& triangle)
{
    const Exact square = squared_distance(point, triangle);
    if (square == 0) return 0;
    // A power of four brings the square near 1, so that its conversion neither overflows nor underflows.
    const V3d reach = {largest(triangle[0] - point), largest(triangle[1] - point), largest(triangle[2] - point)};
    const int exponent = std::ilogb(largest(reach));
    const Exact scale(std::ldexp(1.0, -std::clamp(exponent, -1000, 1000)));
    return std::sqrt(CGAL::to_double(square * scale * scale)) / CGAL::to_double(scale);
}

} // namespace scree
