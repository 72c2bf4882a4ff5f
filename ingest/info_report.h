#pragma once

#include "ingest/particles/particle_series.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace scree {

/// What `scree info --json` says of particle files: frames, and the statistics of one of them. Throws InputError.
nlohmann::json describe_particles(const std::string& pattern, size_t frame, const ParticleReadOptions& options);

/// What `scree info --json` says of a mesh. Throws InputError.
nlohmann::json describe_mesh(const std::string& path);

/// The same for people: a few lines, the last with its line end.
std::string text_of_description(const nlohmann::json& description);

} // namespace scree
