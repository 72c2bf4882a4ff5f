#pragma once

#include "ingest/particles/particle_series.h"

#include <string>
#include <vector>

namespace scree {

/// Parses the values of `--radius`: `R` for all types, `TYPE=R` for one type. Both may be given together, also
/// separated by commas. Throws InputError.
ParticleReadOptions parse_radius_options(const std::vector<std::string>& values);

/// Moves words like `2=0.7` that are not files from `files` to `radii`: CLI11 takes the words that follow
/// `--radius 1=0.5` on the command line for files.
void take_radii_from_files(std::vector<std::string>& files, std::vector<std::string>& radii);

} // namespace scree
