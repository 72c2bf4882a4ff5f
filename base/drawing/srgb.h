#pragma once

#include <algorithm>
#include <cmath>

namespace scree {

/// Encodes linear light for a screen (sRGB, IEC 61966-2-1), clamped to 0..1.
inline float to_srgb(float x)
{
    x = std::clamp(x, 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

} // namespace scree
