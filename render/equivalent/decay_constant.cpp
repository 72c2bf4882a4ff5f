#include "render/equivalent/decay_constant.h"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

/// Whether the system is positive definite: all pivots, from the highest order down, are positive.
bool is_positive_definite(double loss, double g, double kappa)
{
    // For large l the pivots tend to l (1 + sqrt(1 - kappa^2)). Orders above `reach` have no effect: g^l is negligible
    // there, and the recursion forgets its start value on the way down.
    const double root = std::sqrt(std::max(0.0, (1 - kappa) * (1 + kappa)));
    const double reach = std::max(-30 / std::log(std::max(std::abs(g), 1e-10)), 30 / std::max(root, 1e-3));
    const int top = static_cast<int>(std::clamp(reach, 32.0, 100000.0));
    double pivot = (top + 0.5) * (1 + root);
    const double log_g = std::log(std::max(std::abs(g), 1e-300));
    for (int l = top - 1; l >= 0; --l) {
        const double beside = (l + 1) * kappa;
        const double magnitude = l == 0 ? 1 : std::exp(l * log_g),
                     moment = g < 0 && l % 2 == 1 ? -magnitude : magnitude;
        pivot = (2 * l + 1) * (1 - moment + loss * moment) - beside * beside / pivot;
        if (!(pivot > 0)) return false;
    }
    return true;
}

} // namespace

double decay_constant(double albedo, double g)
{
    const double loss = 1 - std::clamp(albedo, 0.0, 1.0);
    if (loss == 0) return 0;
    double low = 0, high = 1;
    for (int i = 0; i < 60 && high - low > 1e-15 * high; ++i) {
        // Small values get the same relative accuracy.
        const double middle = low == 0 && high > 1e-9 ? 0.25 * high : 0.5 * (low + high);
        (is_positive_definite(loss, g, middle) ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double albedo_of_decay(double kappa, double g)
{
    if (kappa <= 0) return 1;
    if (kappa >= 1) return 0;
    // Bisects the loss 1 - albedo, which may be small.
    double low = 0, high = 1;
    for (int i = 0; i < 60 && high - low > 1e-15 * high; ++i) {
        const double middle = low == 0 && high > 1e-15 ? 0.25 * high : 0.5 * (low + high);
        (is_positive_definite(middle, g, kappa) ? high : low) = middle;
    }
    return 1 - 0.5 * (low + high);
}

} // namespace scree
