#pragma once

#include "render/equivalent/core_region.h"

#include <openvdb/openvdb.h>

namespace scree {

/// A lattice: voxel (i, j, k) of a grid with identity transform is at origin + voxel * (i, j, k); the grid's values are
/// in voxels.
struct VoxelLattice {
    V3d origin{0};
    double voxel = 1;

    V3d index(const V3f& p) const { return (V3d(p) - origin) / voxel; }
    V3d place(const V3d& index) const { return origin + index * voxel; }
};

/// The level surface of a field, around the points below `level`; the grid must be of class GRID_LEVEL_SET. For sources
/// that use OpenVDB.
RegionSurface level_surface(const openvdb::FloatGrid& grid, double level, const VoxelLattice& lattice);

/// The region of all points deeper than `depth` below a closed surface (which may have shells that face inwards),
/// computed with voxels of one size; nullopt if it is empty. Throws Cancelled.
std::optional<RegionSurface> inset_on_lattice(const RegionSurface& surface, double depth, const VoxelLattice& lattice,
                                              const Progress& progress);

/// A voxel size, at least `wanted`, with which the band between a surface and its inset has at most 8e6 voxels.
double affordable_voxel(const RegionSurface& surface, double depth, double wanted);

} // namespace scree
