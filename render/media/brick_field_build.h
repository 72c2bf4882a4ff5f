#pragma once

// Private to the sources that build media: this header includes OpenVDB.

#include "base/progress.h"
#include "render/media/brick_field.h"

#include <openvdb/openvdb.h>

#include <string>

namespace scree {

/// Which values a field may have, and its name in error messages.
struct FieldLimits {
    std::string name; ///< "density"
    std::string expected; ///< "finite densities of 0 or more"
    double low = 0, high = 0;
    bool open = false; ///< low and high themselves are excluded
    bool vectors = false; ///< grids of three-component vectors are accepted too
    bool mean_beside = false; ///< an inactive voxel gets the mean of its active neighbours, if it has any
};

/// Copies a grid of floats, doubles or vectors of them into bricks. origin: set to the voxel at field coordinates 0.
///
/// Throws InputError for another type of grid and for values that are not finite or outside the limits (the background
/// is not checked); throws Cancelled.
BrickField make_brick_field(const openvdb::GridBase& grid, const FieldLimits& limits, bool nearest,
                            const std::string& place, const Progress& progress, openvdb::Coord& origin);

} // namespace scree
