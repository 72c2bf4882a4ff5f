#pragma once

#include "base/math.h"
#include "base/progress.h"
#include "render/grains/grain_store.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace scree {

/// The surface of a region, closed; counter-clockwise seen from outside. Every edge of a triangle has its opposite in
/// another one.
struct RegionSurface {
    std::vector<V3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
    double voxel = 0; ///< of the lattice it was found on, which rounds its edges; 0: it was given
    bool coarsened = false; ///< the voxel is larger than wanted, as there would have been too many
};

/// All points inside a closed mesh that are farther than `depth` from it; nothing where there are none.
///
/// Planes are met exactly (but for float); curved faces, and what is next to an edge, to a part of a voxel: there are
/// no points nearer to the mesh than depth - 1 voxel. A voxel is at most depth / 4, or as large as 8e6 voxels in the
/// band between the two surfaces allow. Cavities (shells that face inwards) are outside. depth 0: the mesh itself.
/// Throws InputError (a mesh that is not closed, a depth that is no length), Cancelled.
std::optional<RegionSurface> inset_of_mesh(std::span<const V3f> positions,
                                           std::span<const std::array<uint32_t, 3>> triangles, double depth,
                                           const Progress& progress);

/// Lengths in volume-weighted mean radii of the spheres.
struct HeapOptions {
    double closing = 1.5; ///< radius of the ball that has to fit into a hole for the hole to be outside
    double voxel = 1;
};

/// All points deeper than `depth` below the hull of a heap of spheres; nothing where there are none.
///
/// The hull is the union of the spheres closed by a ball (Serra 1982): what no ball of that radius that meets no sphere
/// covers. So it touches the outermost grains and does not reach beyond them. The same on any number of threads. Throws
/// InputError, Cancelled.
std::optional<RegionSurface> core_of_spheres(std::span<const GrainStore::Sphere> spheres, double depth,
                                             const Progress& progress, const HeapOptions& options = {});

} // namespace scree
