#pragma once

#include "base/content_hash.h"
#include "ingest/meshes/triangle_mesh.h"

namespace scree {

/// Hash of a mesh's vertices and triangles; it depends on their order.
inline uint64_t hash_mesh(const TriangleMesh& mesh, uint64_t seed)
{
    return hash_vector(mesh.triangles, hash_vector(mesh.positions, seed));
}

} // namespace scree
