#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <limits>

namespace scree {

/// Pairs of faces that meet elsewhere than at a shared vertex or edge; vertices at one place count as shared.
struct SelfIntersections {
    uint64_t pairs = 0;
    uint32_t first = 0, second = 0; ///< faces of the lowest pair, when there is one
};

/// Exact (CGAL's predicates), on all threads; positions must be finite and faces have three different corners.
/// enough: the search ends soon after that many pairs are found (a mesh can have the square of its faces); what it then
/// returns is the same on any number of threads.
SelfIntersections find_self_intersections(const TriangleMesh& mesh,
                                          uint64_t enough = std::numeric_limits<uint64_t>::max());

} // namespace scree
