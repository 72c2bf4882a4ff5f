#pragma once

#include "ingest/particles/particle_series.h"

namespace scree {

/// Whether a file that begins like this is an OpenVDB file.
bool is_start_of_vdb(std::string_view start);

/// Files of OpenVDB points: a frame a file, in the order of the files. Steps and counts are read when asked for.
std::unique_ptr<ParticleSeries> open_vdb_points(const std::string& pattern,
                                                const std::vector<std::filesystem::path>& files,
                                                const Progress& progress);

} // namespace scree
