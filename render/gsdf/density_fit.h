#pragma once

#include "render/gsdf/gsdf.h"

#include <array>
#include <cstdint>
#include <vector>

namespace scree {

/// Counts of scattered directions, strata * cells of a Gsdf.
using DirectionCounts = std::vector<uint64_t>;

/// How counts are made smooth.
struct Smoothing {
    std::array<int, 3> passes{2, 2,
                              2}; ///< of a filter 1/4, 1/2, 1/4 along rows (polar angle), columns (azimuth) and strata
    bool twice = true; ///< what the filter takes is filtered as well and added again (Tukey 1977): blurs less
    bool mirror = false; ///< both sides of the plane of incidence count as one
    bool poles = false; ///< columns are smoothed where they are narrower than rows are wide
};

struct DensityFit {
    std::vector<float> density; ///< at the middles of cells, per solid angle, every stratum's masses sum to 1
    /// Mean relative error of the density over what is scattered, the integral of |found - true|, from noise and blur
    /// together: estimated without knowing the truth, by how well each half foretells the other, with the standard
    /// error of the estimate on top. What varies within a cell or a stratum is not in it.
    double error = 0;
    Smoothing smoothing;
};

/// The density behind two independent sets of counts. They are smoothed as far as cross-validation between the halves
/// finds that it lowers the error: features that the counts can resolve stay. How much is scattered by what polar
/// angle, over all strata, is kept as counted. start: where the search for the best smoothing begins.
DensityFit fit_density(const std::array<DirectionCounts, 2>& halves,
                       const std::array<double, Gsdf::strata>& stratum_mass, const Smoothing& start);

} // namespace scree
