#pragma once

#include "render/equivalent/grain_fields.h"

#include <openvdb/openvdb.h>

#include <array>
#include <vector>

namespace scree {

/// For sources that use OpenVDB; all grids have the background 0. Their transform is the identity, as OpenVDB takes
/// small voxels for none: voxel (i, j, k) belongs to the place (i, j, k) * voxel.
struct GrainFields::Grids {
    struct Type {
        openvdb::FloatGrid::Ptr m2, m3, m4; ///< densities of sum of r^k
    };

    double voxel = 0;
    std::vector<uint8_t> codes; ///< of `types`, ascending
    std::vector<Type> types;
    openvdb::FloatGrid::Ptr pack_rate; ///< of all types
};

} // namespace scree
