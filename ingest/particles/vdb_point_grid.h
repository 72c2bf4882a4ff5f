#pragma once

// Private to the sources that write points, because it includes OpenVDB's headers.

#include "ingest/particles/particle_frame.h"

#include <openvdb/points/PointDataGrid.h>

#include <string>

namespace scree {

/// Makes the grid of points that `write_vdb_points` describes. voxel: width of a voxel; 0 means four mean radii.
/// Throws InputError naming `place` when an id does not fit 63 bits.
openvdb::points::PointDataGrid::Ptr make_point_grid(const ParticleFrame& frame, const std::string& name,
                                                    const std::string& place, double voxel = 0);

} // namespace scree
