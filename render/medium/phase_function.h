#pragma once

#include "render/math.h"

namespace scree {

// The phase function of Henyey and Greenstein (1941), -1 < g < 1; cosine: between the ways before and after, 1 is straight on.

/// A cosine, by u in 0..1. Without cancellation for small g.
inline double sample_henyey_greenstein(double g, double u)
{
    const double x = 2 * u - 1, y = 1 + g * x;
    const double cosine = (x + g * (0.5 * (x * x + 3) + g * (x + 0.5 * g * (x * x - 1)))) / (y * y);
    return std::clamp(cosine, -1.0, 1.0);
}

/// Its density per solid angle.
inline double pdf_henyey_greenstein(double g, double cosine)
{
    const double b = (1 - g) * (1 - g) + 2 * g * (1 - cosine);
    return (1 - g * g) / (4 * pi * b * std::sqrt(b));
}

} // namespace scree
