#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace scree {

/// For each position the index of the first one that is exactly the same (its own if there is none before it).
/// Positive and negative zero are the same.
std::vector<uint32_t> first_at_same_position(const std::vector<Imath::V3d>& positions);

} // namespace scree
