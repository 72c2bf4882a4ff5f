#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <functional>

namespace scree {

/// Distance of a surface from the origin along a unit direction; positive.
using RadialFunction = std::function<double(const Imath::V3d& direction)>;

/// The surface that every ray from the origin meets once, as a closed mesh of that many faces (an even number, 20 at
/// least), spread evenly over the directions and looking outwards.
///
/// It cannot intersect itself: each face lies within the cone of its own part of the sphere of directions.
TriangleMesh radial_surface(const RadialFunction& radius, uint64_t triangles);

/// The same over the faces of a convex solid around the origin, which are split evenly: the mesh has edges where the
/// solid has them. It has the solid's number of faces at least.
TriangleMesh radial_surface(const RadialFunction& radius, TriangleMesh solid, uint64_t triangles);

/// The mean edge of a mesh of that many equilateral faces over the unit sphere: what is smaller than twice that, it
/// cannot show.
double mean_edge(uint64_t triangles);

} // namespace scree
