#pragma once

// Private to the sources that build media: this header includes OpenVDB.

#include "base/progress.h"
#include "base/render_space.h"
#include "render/media/grid_medium.h"

#include <Imath/ImathMatrix.h>
#include <openvdb/openvdb.h>

#include <string>

namespace scree {

/// The grids of a medium. Each has its own transform, which must be linear (affine), from voxels to the space that
/// `to_scene` starts from.
struct MediumGrids {
    openvdb::GridBase::ConstPtr density; ///< float, double, vec3s or vec3d; finite, 0 or more; background 0
    openvdb::GridBase::ConstPtr albedo; ///< the same types, in 0..1; may be missing
    openvdb::GridBase::ConstPtr g; ///< float or double, |g| < 1; may be missing
    /// Row vectors as everywhere in Imath: scene point = grid point * to_scene. OpenVDB refuses voxels below 1.4e-5;
    /// this matrix may make them smaller.
    Imath::M44d to_scene;
    std::string place = "medium"; ///< for errors
};

/// Makes a medium from grids in memory.
///
/// In the grids of albedo and g, an inactive voxel next to active ones gets the mean of its active neighbours, so that
/// interpolation near a medium's face does not mix in a meaningless background. Farther out the background is used.
/// Throws InputError for values and transforms that no medium can have, Cancelled.
GridMedium make_grid_medium(const MediumGrids& grids, const GridMediumOptions& options, const RenderSpace& space,
                            const Progress& progress);

} // namespace scree
