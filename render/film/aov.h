#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace scree {

/// What a picture may hold besides its colours.
enum class Aov : uint8_t { albedo, normal, depth, type, id, variance, samples };
inline const std::vector<std::string> aov_names{"albedo", "normal", "depth", "type", "id", "variance", "samples"};

} // namespace scree
