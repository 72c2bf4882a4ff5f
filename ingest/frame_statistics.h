#pragma once

#include "base/progress.h"
#include "ingest/particles/particle_frame.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>

namespace scree {

/// Statistics of the spheres of a frame.
struct FrameStatistics {
    uint64_t particles = 0;
    double radius_min = 0, radius_max = 0, radius_mean = 0;
    std::map<int32_t, uint64_t> count_of_type;
    Imath::V3d lo{0}, hi{0}; ///< bounds of the centres

    /// Volume of the spheres divided by the volume of the box; empty without a box or if its volume is 0.
    std::optional<double> pack_rate;
    /// Part of the middle of the bed that is inside spheres; empty below 1,000 spheres. The middle is the box between
    /// the quartiles of the centres on each axis. Estimated with 2^16 points (standard error below 0.002).
    std::optional<double> bed_pack_rate;

    /// Greatest (r_i + r_j - d) / min(r_i, r_j) over the pairs that overlap, d the distance of the centres; 0 when no
    /// pair overlaps. Spheres of radius 0 do not count.
    double max_overlap = 0;
    std::optional<std::array<uint64_t, 2>> max_overlap_ids; ///< a sphere may overlap its own periodic image
    uint64_t overlapping_pairs = 0;
    /// False when spheres have so many neighbours (wrong radii?) that not all pairs were tested: then
    /// max_overlap and overlapping_pairs are lower bounds.
    bool overlaps_complete = true;

    /// Spheres that have exactly the same centre as an earlier sphere.
    uint64_t duplicates = 0;
};

/// Measures a frame, including periodic images, in parallel; the result is the same on any number of threads.
/// Throws Cancelled.
FrameStatistics measure_frame(const ParticleFrame& frame, const Progress& progress = {});

} // namespace scree
