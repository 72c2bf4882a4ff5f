#pragma once

#include "mixtures/mixture_description.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace scree {

class JsonValue;

/// Reads a mixture: an object with "kind", a grain type's name alone, or {"file": "m.json"}.
///
/// types: the grain types of the scene; a name that is none of them is an error that suggests the nearest. Empty: any
/// name is taken. Files named inside are relative to the file they stand in. Throws InputError.
MixtureDescription read_mixture(const JsonValue& json, const std::vector<std::string>& types = {});

/// The mixture of a file: of a mixture file, or the one at /grains/mixture of a scene. Throws InputError.
MixtureDescription read_mixture_file(const std::filesystem::path& file, const std::vector<std::string>& types = {});

/// The mixture as JSON that reads back as the same one: every kind with all that matters, defaults left out, files
/// relative to `folder`; what "file" referred to stands in its place.
nlohmann::ordered_json write_mixture(const MixtureDescription& mixture, const std::filesystem::path& folder);

} // namespace scree
