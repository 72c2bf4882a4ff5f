#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace scree {

/// A tabulated phase function: the density of the scattering cosine in bins of equal width from -1 to 1.
struct CosineTable {
    static constexpr uint32_t bins = 64;
    std::array<double, bins> density{}; ///< per unit of cosine; integrates to 1

    static uint32_t bin(double cosine)
    {
        return static_cast<uint32_t>(std::clamp(0.5 * (cosine + 1) * bins, 0.0, bins - 1.0));
    }
    static constexpr double width() { return 2.0 / bins; }
};

} // namespace scree
