#pragma once

#include "ingest/particles/particle_frame.h"

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// A fraction and its interval of 95 %.
struct FractionEstimate {
    double value = 0, low = 0, high = 0;
};

/// What a pattern of types on a set of spheres is like.
struct PatternStatistics {
    struct OfType {
        uint64_t count = 0;
        double volume = 0;
        FractionEstimate by_number, by_volume;
    };
    std::vector<OfType> types;
    uint64_t spheres = 0;

    /// How alike spheres at a distance are: (P(same type) - p) / (1 - p), p the chance of two spheres far apart; 1 for
    /// equal types for certain, 0 for none of it.
    struct Correlation {
        double distance, value, standard_error;
    };
    std::vector<Correlation> correlation;
    /// Where the correlation first falls to 1/e, between the points of `correlation` (and 1 at distance 0); 0 when
    /// neighbours do not correlate (within 4 standard errors), infinity when it is above at the last point.
    double correlation_length = 0;
    double mean_spacing = 0; ///< of neighbours, about
};

/// Fractions by number and volume, and the correlation of types in space.
///
/// types[i] < type_count is the type of sphere i; pairs: tried for each distance of the correlation, 0 leaves it out.
/// The intervals tell how far another set of spheres under the same recipe would lie: by the jackknife over 5 x 5 x 5
/// boxes of space, for a pattern makes neighbours alike and few large spheres can hold most of the volume.
/// Deterministic.
PatternStatistics pattern_statistics(const ParticleFrame& frame, std::span<const uint32_t> types, size_t type_count,
                                     size_t pairs = 20000);

} // namespace scree
