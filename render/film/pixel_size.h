#pragma once

#include <cstdint>
#include <limits>

namespace scree {

/// In the place of a number of grains: every one.
inline constexpr uint32_t all_grains = std::numeric_limits<uint32_t>::max();

/// How wide a pixel is at a distance along the view from the camera, in the unit of the camera's lengths: at distance
/// 0, and more for each unit.
struct PixelSize {
    double width = 0, slope = 0;
};

} // namespace scree
