#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Whether the three points are not on one line; exact.
bool has_area(const Imath::V3d& a, const Imath::V3d& b, const Imath::V3d& c);

/// Fills a polygon of n >= 3 corners with n - 2 triangles of the same orientation, and appends them to `triangles`.
///
/// The polygon may be concave and may touch itself, as a polygon that is cut open to encode a hole does. A
/// quadrilateral need not be flat; polygons of more corners are projected along the axis nearest to their normal.
/// Returns false, and appends nothing, if the polygon crosses itself.
bool triangulate_polygon(const std::vector<Imath::V3d>& positions, std::span<const uint32_t> corners,
                         std::vector<std::array<uint32_t, 3>>& triangles);

} // namespace scree
