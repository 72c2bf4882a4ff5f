#pragma once

#include <cstdint>
#include <limits>

namespace scree {

/// Used as a number of grains: all grains.
inline constexpr uint32_t all_grains = std::numeric_limits<uint32_t>::max();

/// The width of a pixel at a distance from the camera along the view, in the unit of the camera's lengths: `width` at
/// distance 0, plus `slope` per unit of distance.
struct PixelSize {
    double width = 0, slope = 0;
};

} // namespace scree
