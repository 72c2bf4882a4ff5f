#pragma once

#include "mixtures/mixture_description.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace scree {

class JsonValue;

/// Reads a mixture: an object with "kind", the name of a grain type alone, or {"file": "m.json"}.
///
/// types: the grain types of the scene; any other name is an error that suggests the nearest type. Empty: any name is
/// accepted. Relative paths start from the folder of the file that contains them. Throws InputError.
MixtureDescription read_mixture(const JsonValue& json, const std::vector<std::string>& types = {});

/// Reads a mixture file, or the mixture at /grains/mixture of a scene file. Throws InputError.
MixtureDescription read_mixture_file(const std::filesystem::path& file, const std::vector<std::string>& types = {});

/// The mixture as JSON that reads back as the same mixture: defaults are left out, paths are relative to `folder`, and
/// {"file": ...} is replaced by the mixture of that file.
nlohmann::ordered_json write_mixture(const MixtureDescription& mixture, const std::filesystem::path& folder);

} // namespace scree
