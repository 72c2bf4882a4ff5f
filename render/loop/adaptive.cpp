#include "render/loop/adaptive.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr double worst_tile = 2; // largest error of a tile, in errors of the picture
constexpr double foresight = 0.5; // fraction of a count that the other half must have drawn to decide the count
constexpr double expected = 0.5; // weight of the tiles around a tile, in sightings of its own
constexpr double caution = 0.5; // standard errors added to an estimate: stopping at a low estimate is too early

double trace(const V3d& v) { return v.x + v.y + v.z; }

/// Calls f with the index (in the film's rows) of every pixel of a tile.
template <class F>
void for_pixels(const Film& film, int tile, const F& f)
{
    const int width = film.x1() - film.x0(), height = film.y1() - film.y0();
    const int x0 = tile % film.tile_columns() * Film::tile_size, y0 = tile / film.tile_columns() * Film::tile_size;
    for (int y = y0; y < std::min(y0 + Film::tile_size, height); ++y) {
        for (int x = x0; x < std::min(x0 + Film::tile_size, width); ++x)
            f(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
    }
}

constexpr double noisy = 0.1; // relative variance of a pixel's mean above which the mean does not show its brightness

/// The mean, scaled so that its square is an unbiased estimate of the true mean's square. A noisier mean is trusted
/// less to be brighter than its tile: the mean of a pixel that hit a rare light once is only noise.
V3d unbiased_scale(const V3d& mean, double variance_of_mean, const V3d& tile_mean)
{
    const double square = mean.dot(mean);
    if (square <= 0) return mean;
    const double corrected = std::max(0.0, square - variance_of_mean),
                 trust = 1 - std::min(1.0, variance_of_mean / (noisy * square));
    return std::sqrt((trust * corrected + (1 - trust) * std::min(corrected, tile_mean.dot(tile_mean))) / square) * mean;
}

/// Relative variance that a half has seen: the mean over the pixels, and the standard error of this mean.
void estimate_variance(const Film& film, int tile, int half, const RelativeError& measure, TileState& state)
{
    TileEstimate& estimate = state.estimates[static_cast<size_t>(half)];
    double sum = 0, squares = 0;
    for_pixels(film, tile, [&](size_t i) {
        const double q = relative_variance(film.halves()[i].judge(half, state.counts),
                                           estimate.sum / static_cast<double>(estimate.pixels), measure);
        sum += q;
        squares += q * q;
    });
    const double n = static_cast<double>(estimate.pixels);
    estimate.variance = sum / n;
    estimate.deviation = n > 1 ? std::sqrt(std::max(0.0, squares / n - estimate.variance * estimate.variance) / (n - 1))
                               : estimate.variance;
}

} // namespace

double relative_variance(const HalfSums& half, const V3d& tile_mean, const RelativeError& measure)
{
    if (half.samples < 2) return 0;
    const double variance = trace(half.variance());
    return measure.of(variance, unbiased_scale(half.mean(), variance / half.samples, tile_mean));
}

void estimate_tiles(Film& film, AdaptivePlan& plan)
{
    std::vector<TileState>& tiles = film.tile_states().tiles;
    for (int half = 0; half < 2; ++half) {
        const auto each_judged = [&](const auto& f) {
            tbb::parallel_for(size_t{0}, tiles.size(), [&](size_t tile) {
                if (plan.judges(tile, half)) f(static_cast<int>(tile), tiles[tile]);
            });
        };
        each_judged([&](int tile, TileState& state) {
            TileEstimate& estimate = state.estimates[static_cast<size_t>(half)];
            estimate = {};
            for_pixels(film, tile, [&](size_t i) {
                ++estimate.pixels;
                estimate.sum += film.halves()[i].judge(half, state.counts).mean();
            });
            const double samples = static_cast<double>(estimate.pixels) * film.tile_states().level;
            estimate.work = std::max(1.0, static_cast<double>(state.work[static_cast<size_t>(half)]) / samples);
        });
        const RelativeError measure(plan.mean(half)); // needs the sums of all tiles
        each_judged([&](int tile, TileState& state) { estimate_variance(film, tile, half, measure, state); });
    }
}

std::optional<ErrorClaim> claimed_error(const Film& film)
{
    V3d mean(0);
    for (const PixelHalves& pixel : film.halves()) {
        if (pixel.half(0).samples + pixel.half(1).samples < 2) return std::nullopt;
        mean += pixel.mean();
    }
    const RelativeError measure(mean / static_cast<double>(std::max<size_t>(1, film.halves().size())));
    ErrorClaim claim;
    double total = 0;
    for (int tile = 0; tile < film.tile_columns() * film.tile_rows(); ++tile) {
        double sum = 0, pixels = 0;
        V3d tile_mean(0);
        for_pixels(film, tile, [&](size_t i) {
            tile_mean += film.halves()[i].mean();
            ++pixels;
        });
        for_pixels(film, tile, [&](size_t i) {
            const double variance = trace(film.halves()[i].variance());
            sum += measure.of(variance, unbiased_scale(film.halves()[i].mean(), variance, tile_mean / pixels));
        });
        total += sum;
        claim.worst_tile = std::max(claim.worst_tile, std::sqrt(sum / pixels));
    }
    claim.picture = std::sqrt(total / static_cast<double>(std::max<size_t>(1, film.halves().size())));
    return claim;
}

AdaptivePlan::AdaptivePlan(TileStates& states, int columns, double error)
    : states_(states), columns_(columns), rows_(static_cast<int>(states.tiles.size()) / columns), error_(error),
      least_(least_samples(error))
{
}

bool AdaptivePlan::finished() const
{
    return std::ranges::all_of(states_.tiles, [this](const TileState& tile) {
        return !tile.counts.going() && std::max(tile.counts.counts[0], tile.counts.counts[1]) <= states_.done;
    });
}

uint32_t AdaptivePlan::least_samples(double error)
{
    return static_cast<uint32_t>(std::ceil(std::clamp(1 / error, 8.0, 1e6)));
}

uint32_t AdaptivePlan::next_level(uint32_t level, uint32_t least)
{
    return level < least ? std::min(2 * level, least) : level + level / 4;
}

std::array<uint32_t, 2> AdaptivePlan::asked(size_t tile) const
{
    const std::array<uint32_t, 2>& counts = states_.tiles[tile].counts.counts;
    std::array<uint32_t, 2> asked{};
    for (int half = 0; half < 2; ++half) {
        const uint32_t count = counts[static_cast<size_t>(half)];
        asked[static_cast<size_t>(half)] = judges(tile, half) ? states_.level : std::min(states_.level, count);
    }
    return asked;
}

V3d AdaptivePlan::mean(int half) const
{
    V3d sum(0);
    int64_t pixels = 0;
    for (const TileState& tile : states_.tiles) {
        sum += tile.estimates[static_cast<size_t>(half)].sum;
        pixels += tile.estimates[static_cast<size_t>(half)].pixels;
    }
    return pixels > 0 ? sum / static_cast<double>(pixels) : V3d(0);
}

/// Samples of each half that every tile should have, estimated from one half.
std::vector<double> AdaptivePlan::wanted(int half) const
{
    std::vector<double> samples, variances;
    double sum = 0, pixels = 0;
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            double around = 0, noise = 0, count = 0;
            for (int r = std::max(0, row - 1); r <= std::min(rows_ - 1, row + 1); ++r) {
                for (int c = std::max(0, column - 1); c <= std::min(columns_ - 1, column + 1); ++c) {
                    const TileEstimate& near =
                        states_.tiles[static_cast<size_t>(r * columns_ + c)].estimates[static_cast<size_t>(half)];
                    const double n = static_cast<double>(near.pixels);
                    around += near.variance * n;
                    noise += near.deviation * near.deviation * n;
                    count += n;
                }
            }
            const TileEstimate& own =
                states_.tiles[static_cast<size_t>(row * columns_ + column)].estimates[static_cast<size_t>(half)];
            double variance = own.variance;
            if (noise > 0) {
                // If all variance came from rare sightings of equally bright light, a tile is expected to have this
                // many sightings. A tile without any may have missed them.
                const double sightings = around * around / (noise * count), known = sightings + expected;
                variance =
                    (sightings * own.variance + expected * around / count) / known * (1 + caution / std::sqrt(known));
            }
            variances.push_back(variance);
            samples.push_back(std::sqrt(variance / own.work));
            sum += std::sqrt(variance * own.work) * static_cast<double>(own.pixels);
            pixels += static_cast<double>(own.pixels);
        }
    }
    const double scale = pixels > 0 ? sum / pixels : 0;
    for (size_t i = 0; i < samples.size(); ++i) {
        const double least = variances[i] / (worst_tile * worst_tile);
        samples[i] =
            std::max(samples[i] * scale, least) / (2 * error_ * error_); // both halves together have twice as many
    }
    return samples;
}

void AdaptivePlan::decide()
{
    needed_ = made_ = 0;
    for (int half = 0; half < 2; ++half) {
        const std::vector<double> samples = wanted(half);
        for (size_t i = 0; i < states_.tiles.size(); ++i) {
            uint32_t& other = states_.tiles[i].counts.counts[static_cast<size_t>(1 - half)];
            const double pixels = static_cast<double>(states_.tiles[i].estimates[0].pixels);
            if (other == undecided && states_.level >= least_ && states_.level >= foresight * samples[i]) {
                other = std::max(states_.level, static_cast<uint32_t>(std::ceil(samples[i])));
            }
            made_ += pixels * std::min(states_.level, other);
            needed_ += pixels * (other == undecided ? std::max<double>(states_.level, samples[i]) : other);
        }
    }
    states_.done = states_.level;
    states_.level = next_level(states_.level, least_);
}

double AdaptivePlan::progress() const { return needed_ > 0 ? made_ / needed_ : 0; }

} // namespace scree
