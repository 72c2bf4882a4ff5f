#pragma once

#include "base/progress.h"
#include "ingest/particles/particle_frame.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>

namespace scree {

/// What can be said of the spheres of a frame.
struct FrameStatistics {
    uint64_t particles = 0;
    double radius_min = 0, radius_max = 0, radius_mean = 0;
    std::map<int32_t, uint64_t> count_of_type;
    Imath::V3d lo{0}, hi{0}; ///< bounds of the centres

    /// Volume of the spheres over that of the box; nothing without a box that has a volume.
    std::optional<double> pack_rate;
    /// The part that spheres cover of the middle of the bed, the box between the quartiles of the centres on each
    /// axis, by 2^16 points (standard error below 0.002); nothing below 1,000 spheres.
    std::optional<double> bed_pack_rate;

    /// Greatest (r_i + r_j - d) / min(r_i, r_j) over the pairs that overlap; 0 when none does.
    /// Pairs with a sphere of no radius do not count.
    double max_overlap = 0;
    std::optional<std::array<uint64_t, 2>> max_overlap_ids; ///< a sphere may overlap its own periodic image
    uint64_t overlapping_pairs = 0;
    /// False when spheres have so many neighbours (wrong radii?) that not all pairs were looked at: then
    /// max_overlap and overlapping_pairs are lower bounds.
    bool overlaps_complete = true;

    /// Spheres whose centre is exactly that of another, less one a place.
    uint64_t duplicates = 0;
};

/// Measures a frame, periodic images included, in parallel; the same answer on any number of threads.
/// Throws Cancelled.
FrameStatistics measure_frame(const ParticleFrame& frame, const Progress& progress = {});

} // namespace scree
