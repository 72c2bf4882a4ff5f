#pragma once

#include "packing/solids/surface_tree.h"

#include <vector>

namespace scree {

/// The pieces of a surface that do not hang together by vertices.
struct MeshShells {
    std::vector<uint32_t> of_face; ///< number of the shell of each face
    uint32_t count = 0;
};

MeshShells find_shells(const TriangleMesh& mesh);

/// Faces, one a shell and the lowest that tells, of the shells that look into the solid: outer shells that look inward,
/// or shells of cavities that look outward. The mesh must be closed, each shell oriented, and nowhere
/// self-intersecting.
std::vector<uint32_t> find_inside_out_shells(const TriangleMesh& mesh, const MeshShells& shells,
                                             const SurfaceTree& tree);

} // namespace scree
