#pragma once

#include "mixtures/mixture_description.h"

#include <cstdint>
#include <filesystem>

namespace scree {

/// Hash of a mixture: of its description and of the contents of its tables and grids. folder: the scene's; the hash
/// stays the same when the scene is moved with all its files.
uint64_t hash_mixture(const MixtureDescription& mixture, const std::filesystem::path& folder, uint64_t seed);

} // namespace scree
