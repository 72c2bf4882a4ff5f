#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <Imath/ImathBox.h>

namespace scree {

struct MeshTopology {
    bool closed = false; ///< every edge has exactly two faces (and there is at least one edge)
    bool oriented = false; ///< the faces at an edge agree on which side is out
};

/// Checks edge by edge; vertices are the same only if their indices are.
MeshTopology topology_of(const TriangleMesh& mesh);

/// Bounds of the vertices that faces use.
Imath::Box3d bounds_of(const TriangleMesh& mesh);

} // namespace scree
