#pragma once

#include "base/math.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace scree {

inline constexpr uint32_t undecided = std::numeric_limits<uint32_t>::max();

/// How many samples of each half count in the pixels of a tile, which may be more than are drawn yet; `undecided` until
/// the other half has said.
///
/// Half 0 has the samples of even number, half 1 those of odd number. counts[0] is decided by half 1 alone and the
/// other way round, so that a half's mean is unbiased whatever was drawn.
struct HalfCounts {
    std::array<uint32_t, 2> counts{undecided, undecided};

    bool going() const { return counts[0] == undecided || counts[1] == undecided; }
};

/// Sums of one half of a pixel's samples.
struct HalfSums {
    uint32_t samples = 0; ///< finite ones
    V3d sum{0}, sum_of_squares{0};

    void add(const V3d& x);
    V3d mean() const { return samples > 0 ? sum / samples : V3d(0); }
    /// Of one sample, per channel; 0 below two samples.
    V3d variance() const;
};

/// The samples of a pixel in two halves that share nothing.
class PixelHalves {
public:
    /// The number of the sample to draw next, the lowest, so that in the end each half has had so many; nothing once it
    /// has.
    std::optional<uint32_t> next(const std::array<uint32_t, 2>& each) const;
    /// A sample was drawn, finite or not.
    void note_drawn(uint32_t number) { ++drawn_[number & 1]; }
    /// number: of the sample, from 0; those past what counts only help to judge the other half.
    void add(uint32_t number, const Color& radiance, const HalfCounts& counts);

    /// What counts of a half.
    const HalfSums& half(int h) const { return halves_[static_cast<size_t>(h)]; }
    /// All samples of a half, those that do not count too, while the other half is undecided.
    HalfSums judge(int h, const HalfCounts& counts) const;
    /// The pixel's value: the mean of both halves' means; of one where the other has none.
    V3d mean() const;
    /// Variance of `mean`, per channel; 0 where neither half has two samples.
    V3d variance() const;

private:
    std::array<uint32_t, 2> drawn_{0, 0};
    std::array<HalfSums, 2> halves_;
    HalfSums late_; ///< of the half that was decided first: at most one goes on for the other's sake
};

/// What the samples of one half say of a tile.
struct TileEstimate {
    int64_t pixels = 0;
    V3d sum{0}; ///< of the pixels' means
    double variance = 0; ///< of one sample, relative (RelativeError), mean over the pixels
    double deviation = 0; ///< standard error of `variance`
    double work = 1; ///< of one sample, mean over the pixels
};

/// A tile: what counts of its halves and what these said last. estimates[h] is of half h, which decides on the other
/// one.
struct TileState {
    HalfCounts counts;
    std::array<uint64_t, 2> work{0, 0}; ///< of all samples of each half, counted or not: rays, and what takes as long
    std::array<TileEstimate, 2> estimates;
};

/// How far a picture has come. Samples are those of a half, wherever they are asked for.
struct TileStates {
    uint32_t done = 0; ///< that there are
    uint32_t level = 1; ///< that there are to be next
    std::vector<TileState> tiles;
};

} // namespace scree
