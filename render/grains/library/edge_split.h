#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <functional>

namespace scree {

/// Splits the longest edge of the mesh, and again, `splits` times: each adds a vertex and splits the faces at the edge
/// in two (two faces more; one at a border). place(middle of the edge) says where the new vertex goes.
///
/// As the longest edge is the longest of both its faces, angles stay bounded (Rivara 1984) where new vertices stand on
/// the edge or near it. Ties go to the older edge. The mesh must be oriented, with at most two faces at an edge.
void split_longest_edges(TriangleMesh& mesh, uint64_t splits,
                         const std::function<Imath::V3d(const Imath::V3d& middle)>& place);

} // namespace scree
