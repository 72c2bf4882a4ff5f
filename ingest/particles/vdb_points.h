#pragma once

#include "ingest/particles/particle_frame.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace scree {

/// Writes a frame as OpenVDB points: a PointDataGrid named "points" with `P`, float `pscale` (radius), int32 `type`,
/// int64 `id` and, where there is one, the orientation `orient`; step, time, units and box as metadata.
///
/// The transform is in double and has the frame's origin as its translation; a place keeps 2^-24 of a voxel, which
/// is four mean radii wide. Throws InputError when the file cannot be written or an id does not fit 63 bits.
void write_vdb_points(const ParticleFrame& frame, const std::filesystem::path& path);

/// A frame as one of several grids of a file.
struct NamedPoints {
    std::string name;
    ParticleFrame frame;
};

/// The same with several grids, in this order; each name once. Programs that look for one grid take the first, or
/// "points".
void write_vdb_points(std::span<const NamedPoints> grids, const std::filesystem::path& path);

/// Reads the first PointDataGrid of a file, sorted by id where it has ids.
///
/// Of the attributes `P` and `pscale` must be there, the rest may be. Throws InputError.
ParticleFrame read_vdb_points(const std::filesystem::path& path);

/// Reads the PointDataGrid of that name. Throws InputError, naming those that are there when it is none of them.
ParticleFrame read_vdb_points(const std::filesystem::path& path, const std::string& name);

/// The names of a file's PointDataGrids, sorted. Throws InputError when it is no OpenVDB file; the list may be empty.
std::vector<std::string> list_vdb_points(const std::filesystem::path& path);

} // namespace scree
