#pragma once

#include "ingest/particles/particle_series.h"

#include <string>
#include <vector>

namespace scree {

/// The values of `--radius`: `R` for all types, `TYPE=R` for one; both may come together and separated by commas.
/// Throws InputError.
ParticleReadOptions parse_radius_options(const std::vector<std::string>& values);

/// Moves words like `2=0.7` from the end of the files to the radii: what follows `--radius 1=0.5` on a command line.
void take_radii_from_files(std::vector<std::string>& files, std::vector<std::string>& radii);

} // namespace scree
