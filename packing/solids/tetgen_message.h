#pragma once

#include <cstdint>

namespace scree {

/// The header of the messages to and from scree-tetgen, in this machine's byte order.
///
/// The request: a header with the counts of points and triangles; points (3 doubles each); triangles (3 uint32 each).
/// The answer: a header with the counts of all points and of tetrahedra; all points, those of the request first;
/// tetrahedra (4 uint32 each); the region number of each tetrahedron (int32; the triangles separate the regions).
struct TetgenHead {
    static constexpr uint64_t request = 0x5c7ee'7e7'0001, answer = 0x5c7ee'7e7'0002;
    uint64_t magic = 0;
    uint64_t points = 0;
    uint64_t cells = 0; ///< triangles or tetrahedra
};

/// scree-tetgen exits with this plus n when TetGen threw the int n.
constexpr int tetgen_threw = 100;

} // namespace scree
