#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <functional>

namespace scree {

/// Distance of a surface from the origin along a unit direction; positive.
using RadialFunction = std::function<double(const Imath::V3d& direction)>;

/// A closed mesh of the surface, which every ray from the origin hits once; its faces are spread evenly over the
/// directions and face outwards. triangles: the number of faces, even, at least 20.
///
/// The mesh cannot intersect itself: each face lies within the cone of its own part of the sphere of directions.
TriangleMesh radial_surface(const RadialFunction& radius, uint64_t triangles);

/// The same, but made by evenly splitting the faces of a convex solid around the origin, so that the mesh has edges
/// where the solid has them. The mesh has at least as many faces as the solid.
TriangleMesh radial_surface(const RadialFunction& radius, TriangleMesh solid, uint64_t triangles);

/// The edge length of that many equilateral faces that cover the unit sphere; a mesh cannot show details smaller than
/// twice this length.
double mean_edge(uint64_t triangles);

} // namespace scree
