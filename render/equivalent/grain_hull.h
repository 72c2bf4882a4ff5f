#pragma once

#include "render/equivalent/level_set_surface.h"

namespace scree {

/// What a heap of spheres fills.
struct GrainHull {
    openvdb::FloatGrid::Ptr
        field; ///< distance from its surface in voxels of the lattice, negative inside; known near the surface
    VoxelLattice lattice;
    RegionSurface surface;
};

/// The union of spheres that are `more` larger. Throws InputError, Cancelled.
GrainHull dilated_spheres(std::span<const GrainStore::Sphere> spheres, double more, const VoxelLattice& lattice,
                          const Progress& progress);

} // namespace scree
