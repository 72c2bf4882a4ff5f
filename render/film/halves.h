#pragma once

#include "base/math.h"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace scree {

inline constexpr uint32_t undecided = std::numeric_limits<uint32_t>::max();

/// How many samples of each half count in the pixels of a tile (perhaps more than are drawn yet); `undecided` until the
/// other half has decided.
///
/// Half 0 has the samples of even number, half 1 those of odd number. Half 1 alone decides counts[0], and half 0 alone
/// decides counts[1], so that the mean of each half is unbiased.
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
    /// Variance of one sample, per channel; 0 below two samples.
    V3d variance() const;
};

/// The samples of a pixel in two independent halves.
class PixelHalves {
public:
    /// The number of the sample to draw next, the lowest one first, until `each` samples of each half are drawn; then
    /// nothing.
    std::optional<uint32_t> next(const std::array<uint32_t, 2>& each) const;
    /// Counts a drawn sample, finite or not.
    void note_drawn(uint32_t number) { ++drawn_[number & 1]; }
    /// number: of the sample, from 0; samples beyond the half's count only help to decide the other half's count.
    void add(uint32_t number, const Color& radiance, const HalfCounts& counts);

    /// The samples of a half that count.
    const HalfSums& half(int h) const { return halves_[static_cast<size_t>(h)]; }
    /// All samples of a half, also those that do not count: they decide the other half's count.
    HalfSums judge(int h, const HalfCounts& counts) const;
    /// The pixel's value: the mean of the two halves' means, or one half's mean where the other has no samples.
    V3d mean() const;
    /// Variance of `mean`, per channel; 0 where neither half has two samples.
    V3d variance() const;

private:
    std::array<uint32_t, 2> drawn_{0, 0};
    std::array<HalfSums, 2> halves_;
    HalfSums late_; ///< samples beyond the count of the half that was decided first; only that half can have these
};

/// Estimates for a tile from the samples of one half.
struct TileEstimate {
    int64_t pixels = 0;
    V3d sum{0}; ///< of the pixels' means
    double variance = 0; ///< of one sample, relative (RelativeError), mean over the pixels
    double deviation = 0; ///< standard error of `variance`
    double work = 1; ///< of one sample, mean over the pixels
};

/// The state of a tile: the counts of its halves, and each half's last estimate. estimates[h] is from half h and
/// decides the other half's count.
struct TileState {
    HalfCounts counts;
    std::array<uint64_t, 2> work{0, 0}; ///< of all samples of each half, counted or not: rays, and steps as costly
    std::array<TileEstimate, 2> estimates;
};

/// How far a picture has come; numbers of samples are per half, in the tiles that still need them.
struct TileStates {
    uint32_t done = 0; ///< samples drawn so far
    uint32_t level = 1; ///< samples to reach next
    std::vector<TileState> tiles;
};

} // namespace scree
