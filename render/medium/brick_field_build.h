#pragma once

// Private to what makes media: it shows OpenVDB's headers.

#include "ingest/support/progress.h"
#include "render/medium/grid_medium_data.h"
#include "render/scene/render_space.h"

#include <Imath/ImathMatrix.h>
#include <openvdb/openvdb.h>

#include <string>

namespace scree {

/// What a field may hold, and how it is called in errors.
struct FieldLimits {
    std::string name;     ///< "density"
    std::string expected; ///< "0 or more"
    double low = 0, high = 0;
    bool open = false;    ///< low and high themselves are excluded
    bool vectors = false; ///< three components are taken too
    bool mean_beside = false; ///< inactive voxels beside active ones count as the mean of those
};

/// Copies a grid of floats, doubles or vectors of them into bricks.
///
/// Throws InputError for another type of grid, a transform that is not linear, values outside of the limits (the background
/// only if it is in use), Cancelled.
PlacedField make_placed_field(const openvdb::GridBase& grid, const FieldLimits& limits, bool nearest, const Imath::M44d& to_scene,
                              const RenderSpace& space, const std::string& place, const Progress& progress);

} // namespace scree
