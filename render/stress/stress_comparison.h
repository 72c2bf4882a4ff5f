#pragma once

#include "render/film/film.h"
#include "render/stress/stress_report.h"

#include <vector>

namespace scree {

/// |z| that one of `tests` normal variables exceeds with a probability of `level` (Sidak).
double critical_z(double level, int tests);

/// Chance that a comparison of pictures that are equal in the mean fails.
inline constexpr double stress_level = 1e-4;

/// Compares two independent pictures in the mean, whole and in squares of `block` pixels, channel by channel: the
/// finding is the worst difference in standard errors. bias: relative difference that is allowed besides noise.
StressFinding compare_means(const Film& a, const Film& b, int block = 8, double bias = 0);

/// The same against what every pixel should be, grey.
StressFinding compare_truth(const Film& a, const std::vector<double>& truth, int block = 8, double bias = 0);

/// What the whole picture lacks to 1 against what it should lack, where that is little; bias: relative to it.
StressFinding compare_loss(const Film& a, double loss, double bias = 0);

/// How many pixels have not the same bits.
StressFinding compare_bits(const Film& a, const Film& b);

/// The largest difference of a pixel's channel from `truth`; allowed: as much.
StressFinding compare_exactly(const Film& a, double truth, double allowed);

} // namespace scree
