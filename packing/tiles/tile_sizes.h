#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace scree {

/// A distribution of radii, up to a scale that follows from the fraction.
struct TileSizes {
    enum class Kind {
        equal, ///< mono
        two, ///< 1 and `ratio`; `share` of the spheres are the larger ones
        lognormal, ///< the logarithm of the radius is normal with standard deviation `sigma`
        power, ///< number density proportional to r^-exponent from 1 to `ratio`
        sample ///< drawn from given radii
    } kind = Kind::equal;
    double ratio = 1.4, share = 0.5, sigma = 0.3, exponent = 3;
    std::vector<double> radii; ///< kind sample
};

/// KIND and its parameters as words: "mono", "bidisperse ratio=1.4 share=0.5", "lognormal sigma=0.3", "power exponent=3
/// ratio=10" (or min=, max=). Throws InputError.
TileSizes parse_tile_sizes(const std::vector<std::string>& words);

/// Describes the distribution in words, e.g. "lognormal of sigma 0.3".
std::string words_of_sizes(const TileSizes& sizes);

/// Draws `count` radii of the distribution in random order, scaled so that the sample's mean is 1.
///
/// Stratified: each of `count` equally likely parts of the distribution gives one radius, so that the sample follows
/// the distribution as closely as its number allows (the larger of two sizes is taken round(share count) times).
/// Deterministic in seed.
std::vector<double> draw_tile_radii(const TileSizes& sizes, uint64_t count, uint64_t seed);

/// The fraction of random close packing after Desmond and Weeks, PRE 90, 022204 (2014), from the distribution's
/// polydispersity (standard deviation over mean) and skewness: 0.634 + 0.0658 delta + 0.0857 S delta^2; at most 0.9.
double random_close_packing(std::span<const double> radii);

} // namespace scree
