#pragma once

#include "render/film/film.h"
#include "render/film/relative_error.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace scree {

/// How many samples each tile of a picture gets so that its error ends at a relative error.
///
/// All tiles that go on are brought to the same level, a fixed sequence of counts a half; then each half says, from its
/// own first samples everywhere alone, how many of the other half's a tile gets, for good, as soon as it has half as
/// many there itself. So how many samples count of a half depends on the other half only, and its mean over them is
/// unbiased; and what it judges by mostly counts too, as the other half gives it more than that. The few samples past
/// its count are not in the picture. The halves count alike: weights by their counts would weigh each by what itself
/// has seen. Biased if done in one: Kirk and Arvo 1991.
///
/// The mean error over the picture is reached with the least work when a tile gets samples by the root of its variance
/// over what one of them costs (Neyman 1934); but no tile is left above twice the error. Costs are rays, not seconds:
/// the same seed draws the same samples on every machine.
class AdaptivePlan {
public:
    /// Works on, and goes on from, the states of rows of tiles. error: relative, as the root of the mean of
    /// RelativeError over the pixels.
    AdaptivePlan(TileStates& states, int columns, double error);

    /// Whether all is decided and drawn.
    bool finished() const;
    /// Whether a half's estimate of a tile is still asked for: the other half is undecided there.
    bool judges(size_t tile, int half) const
    {
        return states_.tiles[tile].counts.counts[static_cast<size_t>(1 - half)] == undecided;
    }

    /// How many samples of each half the pixels of a tile should have by now.
    std::array<uint32_t, 2> asked(size_t tile) const;

    /// Of what the halves of the tiles said last, in all tiles; for the scale of dark pixels.
    V3d mean(int half) const;
    /// Decides for the tiles still going, from estimates at the states' level, which is drawn, and goes to the next
    /// level.
    void decide();
    /// Of all samples that are going to be needed, by the last decision, those that a level makes; 0..1.
    double progress() const;

    /// Of a half, without which nothing is decided: the smaller the error, the rarer the light that must not be missed.
    static uint32_t least_samples(double error);
    /// The level after one: a quarter more, once there are the least samples.
    static uint32_t next_level(uint32_t level, uint32_t least);

private:
    std::vector<double> wanted(int half) const;
    TileStates& states_;
    int columns_, rows_;
    double error_;
    uint32_t least_;
    double needed_ = 0, made_ = 0;
};

/// One pixel's per-sample relative variance, from sums of one half. The square of a noisy mean is too large by the
/// mean's variance, which is taken off it, and where little else is left the pixel counts as no brighter than its tile;
/// what is left of bias is of the order of the squared relative error itself.
double relative_variance(const HalfSums& half, const V3d& tile_mean, const RelativeError& measure);

/// Fills the estimates of the film's halves in the tiles that go on, for `decide`.
void estimate_tiles(Film& film, AdaptivePlan& plan);

/// The error of what counts, as it can be told from the samples: root of the mean of RelativeError over the pixels.
struct ErrorClaim {
    double picture = 0, worst_tile = 0;
};

/// Each half's samples are judged by their own spread, which is unbiased as their number is the other half's choice.
/// Nothing where a pixel has fewer than two samples.
std::optional<ErrorClaim> claimed_error(const Film& film);

} // namespace scree
