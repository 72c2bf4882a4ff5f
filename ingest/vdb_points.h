#pragma once

#include "ingest/particle_frame.h"

#include <filesystem>

namespace scree {

/// Writes a frame as OpenVDB points: a PointDataGrid named "points" with `P`, float `pscale` (radius), int32 `type`,
/// int64 `id` and, where there is one, the orientation `orient`; step, time, units and box as metadata.
///
/// The transform is in double and has the frame's origin as its translation; a place keeps 2^-24 of a voxel, which
/// is four mean radii wide. Throws InputError when the file cannot be written or an id does not fit 63 bits.
void write_vdb_points(const ParticleFrame& frame, const std::filesystem::path& path);

/// Reads the first PointDataGrid of a file, sorted by id where it has ids.
///
/// Of the attributes `P` and `pscale` must be there, the rest may be. Throws InputError.
ParticleFrame read_vdb_points(const std::filesystem::path& path);

} // namespace scree
