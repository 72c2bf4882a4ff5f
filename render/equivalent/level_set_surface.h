#pragma once

#include "render/equivalent/core_region.h"

#include <openvdb/openvdb.h>

namespace scree {

/// Voxel (i, j, k) of a grid of identity transform belongs to origin + voxel * (i, j, k); values are in voxels.
struct VoxelLattice {
    V3d origin{0};
    double voxel = 1;

    V3d index(const V3f& p) const { return (V3d(p) - origin) / voxel; }
    V3d place(const V3d& index) const { return origin + index * voxel; }
};

/// The surface where a field passes `level`, around what is below it; the grid is of the class GRID_LEVEL_SET. For
/// sources that use OpenVDB.
RegionSurface level_surface(const openvdb::FloatGrid& grid, double level, const VoxelLattice& lattice);

/// All points deeper than `depth` below a closed surface (may have shells that face inwards), found in voxels of one
/// size. Throws Cancelled.
std::optional<RegionSurface> inset_on_lattice(const RegionSurface& surface, double depth, const VoxelLattice& lattice,
                                              const Progress& progress);

/// The least voxel, at least `wanted`, with which the band between a surface and its inset has no more voxels than fit.
double affordable_voxel(const RegionSurface& surface, double depth, double wanted);

} // namespace scree
