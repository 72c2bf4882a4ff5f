#pragma once

// Private to the sources that write points: it shows OpenVDB's headers.

#include "ingest/particles/particle_frame.h"

#include <openvdb/points/PointDataGrid.h>

#include <string>

namespace scree {

/// A frame as a grid of points, as write_vdb_points describes it. voxel: 0 for four mean radii. Throws InputError
/// naming `place` when an id does not fit 63 bits.
openvdb::points::PointDataGrid::Ptr make_point_grid(const ParticleFrame& frame, const std::string& name,
                                                    const std::string& place, double voxel = 0);

} // namespace scree
