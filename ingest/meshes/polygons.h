#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Whether the three points span a triangle: exact.
bool has_area(const Imath::V3d& a, const Imath::V3d& b, const Imath::V3d& c);

/// Appends triangles (of the same orientation) that fill a polygon of n >= 3 corners with n - 2 triangles.
///
/// The polygon may be concave and may touch itself, as one does that is cut open to encode a hole. A quadrilateral need
/// not be flat; others are filled as seen along the axis their normal is nearest to. False, with nothing appended, for
/// a polygon that crosses itself.
bool triangulate_polygon(const std::vector<Imath::V3d>& positions, std::span<const uint32_t> corners,
                         std::vector<std::array<uint32_t, 3>>& triangles);

} // namespace scree
