#pragma once

// Private to the sources that build media: this header includes OpenVDB.

#include "base/render_space.h"
#include "render/media/brick_field_build.h"
#include "render/media/grid_medium_data.h"

#include <Imath/ImathMatrix.h>

namespace scree {

/// A grid as bricks, with its transform to render coordinates.
///
/// Throws like make_brick_field(), and InputError for a transform that is not linear or cannot be inverted.
PlacedField make_placed_field(const openvdb::GridBase& grid, const FieldLimits& limits, bool nearest,
                              const Imath::M44d& to_scene, const RenderSpace& space, const std::string& place,
                              const Progress& progress);

} // namespace scree
