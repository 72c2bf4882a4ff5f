#pragma once

#include "mixtures/mixture_description.h"

#include <cstdint>
#include <filesystem>

namespace scree {

/// Hash of a mixture: of all that it says, and of what its tables and grids hold. folder: of the scene, which may be
/// moved with all its files.
uint64_t hash_mixture(const MixtureDescription& mixture, const std::filesystem::path& folder, uint64_t seed);

} // namespace scree
