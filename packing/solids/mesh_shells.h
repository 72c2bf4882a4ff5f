#pragma once

#include "packing/solids/surface_tree.h"

#include <vector>

namespace scree {

/// The pieces of a surface that share no vertex with one another.
struct MeshShells {
    std::vector<uint32_t> of_face; ///< number of the shell of each face
    uint32_t count = 0;
};

MeshShells find_shells(const TriangleMesh& mesh);

/// Finds the shells that face into the solid (outer shells that face inward, and shells of cavities that face outward),
/// and returns the lowest-numbered face of each that is not vertical. The mesh must be closed and free of
/// self-intersections, and each shell must be oriented.
std::vector<uint32_t> find_inside_out_shells(const TriangleMesh& mesh, const MeshShells& shells,
                                             const SurfaceTree& tree);

} // namespace scree
