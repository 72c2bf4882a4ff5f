#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <vector>

namespace scree {

/// Points p with normal . p <= distance; unit normal.
struct HalfSpace {
    Imath::V3d normal;
    double distance;
};

/// The boundary of the bounded intersection of half-spaces around the origin (distances > 0), faces fanned into
/// triangles, looking outwards. Those that do not touch it add nothing. Corners of four faces are split into two by a
/// hair.
TriangleMesh convex_polyhedron(std::vector<HalfSpace> half_spaces);

/// Distance from the origin to the surface of the intersection along a unit direction, with edges rounded: the p-norm
/// (sum (normal . direction / distance)^p)^(-1/p) with p = 1 / rounding instead of the largest term.
double rounded_distance(const std::vector<HalfSpace>& half_spaces, double rounding, const Imath::V3d& direction);

} // namespace scree
