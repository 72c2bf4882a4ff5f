#pragma once

#include "render/math.h"

#include <array>

namespace scree {

/// Unit normal of a triangle, counter-clockwise from outside.
inline V3d unit_normal(const std::array<V3d, 3>& corners)
{
    return (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
}

/// Whether o + t d meets the triangle at some t > 0, in double (Möller and Trumbore 1997); a ray from its plane does not.
/// rounding: by how much o may lie off its true place.
inline bool meets_triangle(const std::array<V3d, 3>& corners, const V3d& o, const V3d& d, double rounding)
{
    const V3d e1 = corners[1] - corners[0], e2 = corners[2] - corners[0], s = o - corners[0];
    const V3d n = e1.cross(e2);
    const double det = d.dot(n), height = -s.dot(n);
    if (std::abs(height) <= rounding * n.length()) return false;
    if (!(height / det > 0)) return false;
    const V3d q = s.cross(d);
    const double u = -e2.dot(q) / det, v = e1.dot(q) / det;
    return u >= 0 && v >= 0 && u + v <= 1;
}

} // namespace scree
