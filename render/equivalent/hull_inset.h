#pragma once

#include "render/equivalent/grain_hull.h"

namespace scree {

/// The region of all points deeper than `depth` below a hull, computed with voxels of one size; nullopt if it is empty.
/// Throws Cancelled.
std::optional<RegionSurface> inset_of_hull(const GrainHull& hull, double depth, const VoxelLattice& lattice,
                                           const Progress& progress);

} // namespace scree
