#pragma once

// Private to what makes media: it shows OpenVDB's headers.

#include "base/progress.h"
#include "base/render_space.h"
#include "render/media/grid_medium.h"

#include <Imath/ImathMatrix.h>
#include <openvdb/openvdb.h>

#include <string>

namespace scree {

/// The grids of a medium. Each has its own transform, which must be linear (affine), from voxels to places in
/// `to_scene`'s space.
struct MediumGrids {
    openvdb::GridBase::ConstPtr density; ///< float, double, vec3s or vec3d; finite, 0 or more; background 0
    openvdb::GridBase::ConstPtr albedo; ///< the same types, in 0..1; may be missing
    openvdb::GridBase::ConstPtr g; ///< float or double, |g| < 1; may be missing
    /// Row vectors as everywhere in Imath: scene place = grid place * to_scene. OpenVDB refuses voxels below 1.4e-5;
    /// this does not.
    Imath::M44d to_scene;
    std::string place = "medium"; ///< for errors
};

/// Makes a medium of grids in memory.
///
/// Where the grids of albedo and g have inactive voxels beside active ones, those count as the mean of their active
/// neighbours: interpolation near a medium's face does not mix in a background that means nothing. Farther out the
/// background counts. Throws InputError for values and transforms that no medium can have, Cancelled.
GridMedium make_grid_medium(const MediumGrids& grids, const GridMediumOptions& options, const RenderSpace& space,
                            const Progress& progress);

} // namespace scree
