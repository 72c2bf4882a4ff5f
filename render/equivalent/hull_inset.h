#pragma once

#include "render/equivalent/grain_hull.h"

namespace scree {

/// All points deeper than `depth` below a hull, found in voxels of one size; nothing where there are none. Throws
/// Cancelled.
std::optional<RegionSurface> inset_of_hull(const GrainHull& hull, double depth, const VoxelLattice& lattice,
                                           const Progress& progress);

} // namespace scree
