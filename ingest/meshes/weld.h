#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace scree {

/// For each position, the index of the first position that is exactly equal (its own index if no earlier one is).
/// Positive and negative zero are the same.
std::vector<uint32_t> first_at_same_position(const std::vector<Imath::V3d>& positions);

} // namespace scree
