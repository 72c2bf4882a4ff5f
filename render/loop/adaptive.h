#pragma once

#include "render/film/film.h"
#include "render/film/relative_error.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace scree {

/// Chooses how many samples each tile of a picture gets so that the picture reaches a relative error.
///
/// The samples of a pixel form two halves. All unfinished tiles are drawn to the same level: a count for each half,
/// from a fixed sequence. Then each half computes, from its own samples alone, how many samples the other half of a
/// tile gets. This count is final, and it is set as soon as the first half has half as many samples in the tile. So the
/// number of samples that count of a half depends on the other half only, and the mean over them is unbiased. Most
/// samples that a half judges by count too, because the other half gives it more than that. The few samples beyond a
/// half's count are not in the picture. Both halves have the same weight: weights by counts would weight each half by
/// what it has seen itself. Stopping by the same samples that are averaged is biased (Kirk and Arvo 1991).
///
/// The mean error over the picture is reached with the least work if the samples of a tile are proportional to the root
/// of its variance over the cost of one sample (Neyman 1934); but no tile is left above twice the error. Costs are
/// rays, not seconds: the same seed draws the same samples on every machine.
class AdaptivePlan {
public:
    /// Continues from the states of the tiles, which are in rows of `columns`, and changes them. error: relative, the
    /// root of the mean of RelativeError over the pixels.
    AdaptivePlan(TileStates& states, int columns, double error);

    /// Whether all counts are decided and drawn.
    bool finished() const;
    /// Whether a half's estimate of a tile is still needed: the count of the other half is undecided.
    bool judges(size_t tile, int half) const
    {
        return states_.tiles[tile].counts.counts[static_cast<size_t>(1 - half)] == undecided;
    }

    /// How many samples of each half the pixels of a tile should have at the current level.
    std::array<uint32_t, 2> asked(size_t tile) const;

    /// Mean of the picture by the latest estimates of one half; sets the scale for dark pixels.
    V3d mean(int half) const;
    /// Decides counts for the unfinished tiles from estimates at the current level, which is drawn, and moves to the
    /// next level.
    void decide();
    /// Samples drawn at the last decision, as a fraction of all that it found necessary; 0..1.
    double progress() const;

    /// Samples of a half below which nothing is decided: a smaller error must not miss rarer light.
    static uint32_t least_samples(double error);
    /// The next level: a quarter more, once least_samples() is reached, and up to double before.
    static uint32_t next_level(uint32_t level, uint32_t least);

private:
    std::vector<double> wanted(int half) const;
    TileStates& states_;
    int columns_, rows_;
    double error_;
    uint32_t least_;
    double needed_ = 0, made_ = 0;
};

/// One pixel's per-sample relative variance, from the sums of one half. The square of a noisy mean is too large by the
/// mean's variance, so this variance is subtracted. If little else is left, the pixel counts as no brighter than its
/// tile. The remaining bias is of the order of the squared relative error.
double relative_variance(const HalfSums& half, const V3d& tile_mean, const RelativeError& measure);

/// Computes the estimates of the film's halves in the unfinished tiles, for AdaptivePlan::decide().
void estimate_tiles(Film& film, AdaptivePlan& plan);

/// The picture's error as estimated from its samples: the root of the mean of RelativeError over the pixels.
struct ErrorClaim {
    double picture = 0, worst_tile = 0;
};

/// The estimated error of a film; nothing if a pixel has fewer than two samples. It uses the spread of each half's
/// samples, which is unbiased because the other half chose their number.
std::optional<ErrorClaim> claimed_error(const Film& film);

} // namespace scree
