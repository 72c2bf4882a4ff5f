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

/// The closed surface of a region; triangles are counter-clockwise seen from outside. For every edge of a triangle,
/// another triangle has the opposite edge.
struct RegionSurface {
    std::vector<V3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
    double voxel = 0; ///< voxel of the lattice on which it was computed, which rounds its edges; 0: a given mesh
    bool coarsened = false; ///< the voxel is larger than wanted, to limit the number of voxels
};

/// The region of all points inside a closed mesh that are farther than `depth` from it; nullopt if it is empty.
///
/// Plane faces are exact (up to float rounding); curved faces and points near edges have an error below a voxel: no
/// point of the region is nearer to the mesh than depth - 1 voxel. A voxel is at most depth / 4, or larger if the band
/// between the two surfaces would need more than 8e6 voxels. Cavities (shells that face inwards) are outside. depth 0:
/// the mesh itself. Throws InputError (a mesh that is not closed, a depth that is negative or not finite), Cancelled.
std::optional<RegionSurface> inset_of_mesh(std::span<const V3f> positions,
                                           std::span<const std::array<uint32_t, 3>> triangles, double depth,
                                           const Progress& progress);

/// Lengths in units of the spheres' volume-weighted mean radius.
struct HeapOptions {
    double closing = 1.5; ///< radius of the closing ball: a hole counts as outside if this ball fits into it
    double voxel = 1;
};

/// The region of all points deeper than `depth` below the hull of a heap of spheres; nullopt if it is empty.
///
/// The hull is the morphological closing of the union of the spheres by a ball (Serra 1982): all points that no ball of
/// that radius can cover without intersecting a sphere. So it touches the outermost grains and does not reach beyond
/// them. The result is the same for any number of threads. Throws InputError, Cancelled.
std::optional<RegionSurface> core_of_spheres(std::span<const GrainStore::Sphere> spheres, double depth,
                                             const Progress& progress, const HeapOptions& options = {});

} // namespace scree
