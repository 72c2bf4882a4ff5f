#pragma once

#include "base/math.h"
#include "base/warp.h"

namespace scree {

enum class FilterKind : uint8_t { box, tent, gaussian };

/// The reconstruction filter, importance sampled: a pixel's samples are drawn around its middle with the filter's
/// density, so that a pixel is the plain mean of its own samples (Ernst, Stamminger, Greiner 2006).
///
/// Pixels stay independent: a crop is bit for bit the same as this part of the whole picture.
struct Filter {
    FilterKind kind = FilterKind::gaussian;
    double radius = 1.5; ///< pixels; box: half the width; gaussian: where it is cut off, 3 standard deviations

    /// Offset from the pixel's middle, in pixels.
    V2d sample(double u1, double u2) const
    {
        switch (kind) {
        case FilterKind::box: return {radius * (2 * u1 - 1), radius * (2 * u2 - 1)};
        case FilterKind::tent: return {radius * tent(u1), radius * tent(u2)};
        case FilterKind::gaussian: break;
        }
        const double sigma = radius / 3;
        const double r = sigma * std::sqrt(-2 * std::log(1 - u1 * (1 - std::exp(-4.5))));
        return {r * std::cos(2 * pi * u2), r * std::sin(2 * pi * u2)};
    }

private:
    static double tent(double u) { return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u); }
};

} // namespace scree
