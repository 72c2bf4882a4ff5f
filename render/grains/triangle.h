#pragma once

#include "render/math.h"

#include <array>

namespace scree {

/// Unit normal of a triangle, counter-clockwise from outside.
inline V3d unit_normal(const std::array<V3d, 3>& corners)
{
    return (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
}

/// Whether a point lies in the triangle's plane but for the rounding of double arithmetic. A ray from there does not meet
/// the triangle: what Embree finds in float is the rounding of a neighbour's edge.
inline bool starts_on_plane(const std::array<V3d, 3>& corners, const V3d& point)
{
    const V3d to = corners[0] - point;
    // A few roundings of 2^-53 of the coordinates that went in.
    const double bound = 0x1p-48 * (corners[0].length() + point.length());
    return std::abs(to.dot(unit_normal(corners))) <= bound;
}

} // namespace scree
