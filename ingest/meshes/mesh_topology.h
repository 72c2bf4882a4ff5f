#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <Imath/ImathBox.h>

namespace scree {

struct MeshTopology {
    bool closed = false; ///< every edge has exactly two faces (and there is one)
    bool oriented = false; ///< the faces at an edge agree on which side is out
};

/// Edge by edge, by the indices of the vertices.
MeshTopology topology_of(const TriangleMesh& mesh);

/// Of the vertices that faces use.
Imath::Box3d bounds_of(const TriangleMesh& mesh);

} // namespace scree
