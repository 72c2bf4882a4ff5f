#pragma once

#include <cstdint>

namespace scree {

/// What goes to scree-tetgen and comes back, in this machine's byte order.
///
/// There: a head with the counts of points and triangles; points (3 doubles each); triangles (3 uint32 each). Back: a
/// head with the counts of all points and of tetrahedra; all points, those sent first; tetrahedra (4 uint32 each); the
/// number of each one's region (int32; regions are separated by the triangles).
struct TetgenHead {
    static constexpr uint64_t request = 0x5c7ee'7e7'0001, answer = 0x5c7ee'7e7'0002;
    uint64_t magic = 0;
    uint64_t points = 0;
    uint64_t cells = 0; ///< triangles or tetrahedra
};

/// scree-tetgen's exit status when TetGen threw the int n: this plus n.
constexpr int tetgen_threw = 100;

} // namespace scree
