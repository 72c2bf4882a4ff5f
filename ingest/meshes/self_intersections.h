#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <limits>

namespace scree {

/// Pairs of faces that meet elsewhere than at a shared vertex or edge; vertices at the same place count as shared.
struct SelfIntersections {
    uint64_t pairs = 0;
    uint32_t first = 0, second = 0; ///< faces of the lowest pair, when there is one
};

/// Finds the pairs exactly (CGAL's predicates), on all threads. Positions must be finite, and the three corners of a
/// face must differ. enough: the search ends soon after it found this many pairs (a mesh can have as many as the square
/// of its faces). The result is the same on any number of threads.
SelfIntersections find_self_intersections(const TriangleMesh& mesh,
                                          uint64_t enough = std::numeric_limits<uint64_t>::max());

} // namespace scree
