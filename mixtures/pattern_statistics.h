#pragma once

#include "ingest/particles/particle_frame.h"

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// A fraction and its 95 % confidence interval.
struct FractionEstimate {
    double value = 0, low = 0, high = 0;
};

/// Statistics of the types of a set of spheres.
struct PatternStatistics {
    struct OfType {
        uint64_t count = 0;
        double volume = 0;
        FractionEstimate by_number, by_volume;
    };
    std::vector<OfType> types;
    uint64_t spheres = 0;

    /// Correlation of the types of two spheres at a distance: (P(same type) - p) / (1 - p), where p is P(same type) of
    /// two spheres far apart; 1: always the same type, 0: independent types.
    struct Correlation {
        double distance, value, standard_error;
    };
    std::vector<Correlation> correlation;
    /// Distance where the correlation first falls to 1/e, interpolated between the points of `correlation` (and 1 at
    /// distance 0); 0 when neighbours do not correlate (within 4 standard errors), infinity when the correlation is
    /// above 1/e at the last point.
    double correlation_length = 0;
    double mean_spacing = 0; ///< distance between neighbours, approximate
};

/// Fractions by number and volume, and the correlation of types in space.
///
/// types[i] < type_count is the type of sphere i; pairs: pairs of spheres tried for each distance, 0: no correlation.
/// The intervals estimate how far another set of spheres with the same recipe would differ. They use the jackknife over
/// 5 x 5 x 5 boxes of space, because in a pattern neighbours are alike and few large spheres can hold most of the
/// volume. Deterministic.
PatternStatistics pattern_statistics(const ParticleFrame& frame, std::span<const uint32_t> types, size_t type_count,
                                     size_t pairs = 20000);

} // namespace scree
