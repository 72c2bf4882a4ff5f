#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <vector>

namespace scree {

/// Points p with normal . p <= distance; unit normal.
struct HalfSpace {
    Imath::V3d normal;
    double distance;
};

/// The boundary of the intersection of half-spaces around the origin (distances > 0), which must be bounded. Its faces
/// are fans of triangles and face outwards. Half-spaces that do not touch the boundary add nothing. A corner of four
/// faces becomes two corners very close together.
TriangleMesh convex_polyhedron(std::vector<HalfSpace> half_spaces);

/// Distance from the origin to the surface of the intersection along a unit direction, with rounded edges: it uses the
/// p-norm (sum (normal . direction / distance)^p)^(-1/p), p = 1 / rounding, instead of the largest term.
double rounded_distance(const std::vector<HalfSpace>& half_spaces, double rounding, const Imath::V3d& direction);

} // namespace scree
