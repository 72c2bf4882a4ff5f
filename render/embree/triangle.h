#pragma once

#include "base/math.h"

#include <array>

namespace scree {

/// Unit outward normal of a triangle; its corners are counter-clockwise seen from outside.
inline V3d unit_normal(const std::array<V3d, 3>& corners)
{
    return (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
}

/// Where o + t d meets the plane of a triangle: corners[0] + u (corners[1] - corners[0]) + v (corners[2] - corners[0]).
struct PlaneHit {
    double t, u, v; ///< not finite for a ray parallel to the plane
};

/// Intersects the line o + t d with the triangle's plane, in double (Möller and Trumbore 1997).
inline PlaneHit meet_plane(const std::array<V3d, 3>& corners, const V3d& o, const V3d& d)
{
    const V3d e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], s = o - corners[0];
    const V3d n = e1.cross(e2), q = s.cross(d);
    const double det = d.dot(n);
    return {-s.dot(n) / det, -e2.dot(q) / det, e1.dot(q) / det};
}

/// Whether o + t d hits the triangle at some t > 0; false if o lies in the triangle's plane, within `rounding`.
/// rounding: how far o may be from its true place.
inline bool meets_triangle(const std::array<V3d, 3>& corners, const V3d& o, const V3d& d, double rounding)
{
    const V3d n = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (std::abs((o - corners[0]).dot(n)) <= rounding * n.length()) return false;
    const PlaneHit hit = meet_plane(corners, o, d);
    return hit.t > 0 && hit.u >= 0 && hit.v >= 0 && hit.u + hit.v <= 1;
}

} // namespace scree
