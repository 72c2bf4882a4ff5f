#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <functional>

namespace scree {

/// Splits the longest edge of the mesh, `splits` times. Each split adds a vertex and splits the faces at the edge in
/// two (two faces more; at a border one more). place(middle of the edge) gives the position of the new vertex.
///
/// The longest edge of the mesh is also the longest of both its faces, so angles stay bounded (Rivara 1984) if new
/// vertices are on the edge or near it. Of equally long edges the older is split first. The mesh must be oriented, with
/// at most two faces at an edge.
void split_longest_edges(TriangleMesh& mesh, uint64_t splits,
                         const std::function<Imath::V3d(const Imath::V3d& middle)>& place);

} // namespace scree
