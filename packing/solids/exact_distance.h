#pragma once

#include <Imath/ImathVec.h>

#include <array>

namespace scree {

/// Corners of a triangle.
using Corners = std::array<Imath::V3d, 3>;

/// A distance known to lie in lo..hi.
struct DistanceBounds {
    double lo, hi;
};

/// Proven bounds on the distance from a point to a triangle; they differ by some 1e-14 of the distance to the farthest
/// corner.
///
/// scale: a power of two that scales differences of places to a magnitude of about 1; the bounds are of the scaled
/// distance.
DistanceBounds bound_distance(const Imath::V3d& point, const Corners& triangle, double scale);

/// Whether the triangle is nearer to the point than `distance` (not negative), in exact arithmetic. Inputs: finite.
bool is_nearer_exactly(const Imath::V3d& point, const Corners& triangle, double distance);

/// Whether the point lies on the triangle, in exact arithmetic.
bool touches_exactly(const Imath::V3d& point, const Corners& triangle);

/// The distance; its square is computed in exact arithmetic.
double distance_exactly(const Imath::V3d& point, const Corners& triangle);

} // namespace scree
