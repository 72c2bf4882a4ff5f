#pragma once

#include "render/gsdf/gsdf.h"

#include <array>
#include <cstdint>
#include <vector>

namespace scree {

/// Counts of scattered directions, strata * cells of a Gsdf.
using DirectionCounts = std::vector<uint64_t>;

/// How counts are smoothed.
struct Smoothing {
    /// Passes of the filter 1/4, 1/2, 1/4 along rows (polar angle), columns (azimuth) and strata.
    std::array<int, 3> passes{2, 2, 2};
    bool twice = true; ///< also filters what the filter removed, and adds it back (Tukey 1977): blurs less
    bool mirror = false; ///< averages the two sides of the plane of incidence
    bool poles = false; ///< smooths across columns where these are narrower than rows are wide
};

struct DensityFit {
    std::vector<float> density; ///< per solid angle, one value per cell; the masses of each stratum sum to 1
    /// Estimated mean relative error of the density, weighted by the scattered light: the integral of |found - true|,
    /// from noise and blur together. The estimate does not need the truth: it is how well each half predicts the
    /// other, plus the standard error of this estimate. Variation within a cell or a stratum is not included.
    double error = 0;
    Smoothing smoothing;
};

/// Estimates the density of directions from two independent sets of counts.
///
/// Counts are smoothed only as far as cross-validation between the two halves finds that this lowers the error:
/// features that the counts can resolve stay. The share of each polar angle, summed over all strata, is kept as
/// counted. start: where the search for the best smoothing begins.
DensityFit fit_density(const std::array<DirectionCounts, 2>& halves,
                       const std::array<double, Gsdf::strata>& stratum_mass, const Smoothing& start);

} // namespace scree
