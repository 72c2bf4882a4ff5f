#pragma once

#include "render/equivalent/level_set_surface.h"

namespace scree {

/// The hull of a heap of spheres, as a field and as a surface.
struct GrainHull {
    openvdb::FloatGrid::Ptr
        field; ///< Distance from the surface in voxels of the lattice, negative inside; known only near the surface.
    VoxelLattice lattice;
    RegionSurface surface;
};

/// The union of the spheres with radii increased by `more`. Throws InputError, Cancelled.
GrainHull dilated_spheres(std::span<const GrainStore::Sphere> spheres, double more, const VoxelLattice& lattice,
                          const Progress& progress);

} // namespace scree
