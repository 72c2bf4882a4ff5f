#pragma once

#include "render/equivalent/grain_fields.h"

#include <openvdb/openvdb.h>

#include <array>
#include <vector>

namespace scree {

/// For sources that use OpenVDB; all grids have background 0. Their transform is the identity, because OpenVDB refuses
/// very small voxels: voxel (i, j, k) belongs to the point (i, j, k) * voxel.
struct GrainFields::Grids {
    struct Type {
        openvdb::FloatGrid::Ptr m2, m3, m4; ///< densities of sum of r^k
    };

    double voxel = 0;
    std::vector<uint8_t> codes; ///< type codes of `types`, ascending
    std::vector<Type> types;
    openvdb::FloatGrid::Ptr pack_rate; ///< of all types
};

} // namespace scree
