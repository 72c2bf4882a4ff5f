#pragma once

// Private to what makes media: it shows OpenVDB's headers.

#include "base/progress.h"
#include "render/media/brick_field.h"

#include <openvdb/openvdb.h>

#include <string>

namespace scree {

/// What a field may hold, and how it is called in errors.
struct FieldLimits {
    std::string name; ///< "density"
    std::string expected; ///< "finite densities of 0 or more"
    double low = 0, high = 0;
    bool open = false; ///< low and high themselves are excluded
    bool vectors = false; ///< three components are taken too
    bool mean_beside = false; ///< inactive voxels beside active ones count as the mean of those
};

/// Copies a grid of floats, doubles or vectors of them into bricks. origin: the voxel that field coordinates 0 stand
/// for.
///
/// Throws InputError for another type of grid, values that are not finite or outside of the limits (the background is
/// not looked at), Cancelled.
BrickField make_brick_field(const openvdb::GridBase& grid, const FieldLimits& limits, bool nearest,
                            const std::string& place, const Progress& progress, openvdb::Coord& origin);

} // namespace scree
