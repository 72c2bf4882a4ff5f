#pragma once

#include "ingest/particles/particle_frame.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace scree {

/// Writes a frame as OpenVDB points: a PointDataGrid named "points" with `P`, float `pscale` (radius), int32 `type`,
/// int64 `id` (if the frame has ids) and `orient` (if it has orientations); step, time, units and box as metadata.
///
/// The transform is in double and translates by the frame's origin. Positions are exact to 2^-24 of a voxel; a voxel
/// is four mean radii wide. Throws InputError when the file cannot be written or an id does not fit 63 bits.
void write_vdb_points(const ParticleFrame& frame, const std::filesystem::path& path);

/// A frame that becomes one of several grids of a file.
struct NamedPoints {
    std::string name;
    ParticleFrame frame;
};

/// Writes several frames as grids of one file, in this order; the names must differ. Programs that look for one grid
/// take the first or the one named "points".
void write_vdb_points(std::span<const NamedPoints> grids, const std::filesystem::path& path);

/// Reads the first PointDataGrid of a file, sorted by id where it has ids.
///
/// The attributes `P` and `pscale` are required, the others are optional. Throws InputError.
ParticleFrame read_vdb_points(const std::filesystem::path& path);

/// Reads the PointDataGrid of that name. Throws InputError; if no grid has this name, the error lists the names.
ParticleFrame read_vdb_points(const std::filesystem::path& path, const std::string& name);

/// The names of a file's PointDataGrids, sorted. Throws InputError if it is not an OpenVDB file; the list may be empty.
std::vector<std::string> list_vdb_points(const std::filesystem::path& path);

} // namespace scree
