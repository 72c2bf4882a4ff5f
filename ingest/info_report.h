#pragma once

#include "ingest/particles/dump_series.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace scree {

/// What `scree info --json` says of a dump: frames, and the statistics of one of them. Throws InputError.
nlohmann::json describe_dump(const std::string& pattern, size_t frame, const DumpReadOptions& options);

/// The same of a .vdb file of points. Throws InputError.
nlohmann::json describe_points(const std::string& path);

/// What `scree info --json` says of a mesh. Throws InputError.
nlohmann::json describe_mesh(const std::string& path);

/// The same for people: a few lines, the last with its line end.
std::string text_of_description(const nlohmann::json& description);

} // namespace scree
