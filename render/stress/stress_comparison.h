#pragma once

#include "render/film/film.h"
#include "render/stress/stress_report.h"

#include <vector>

namespace scree {

/// The value that the largest |z| of `tests` standard normal variables exceeds with probability `level` (Sidak).
double critical_z(double level, int tests);

/// Probability that a comparison fails though the pictures have equal means.
inline constexpr double stress_level = 1e-4;

/// Compares the means of two independent pictures, over the whole picture and over squares of `block` pixels a side,
/// channel by channel: the finding is the worst difference in standard errors. bias: relative difference that is
/// allowed in addition to noise.
StressFinding compare_means(const Film& a, const Film& b, int block = 8, double bias = 0);

/// The same against the true grey value of every pixel.
StressFinding compare_truth(const Film& a, const std::vector<double>& truth, int block = 8, double bias = 0);

/// Compares 1 minus the mean of the whole picture with `loss`, its true value, which is small. bias: relative to
/// `loss`.
StressFinding compare_loss(const Film& a, double loss, double bias = 0);

/// The number of pixels whose bits differ.
StressFinding compare_bits(const Film& a, const Film& b);

/// The largest difference of a pixel's channel from `truth`. allowed: the largest that passes.
StressFinding compare_exactly(const Film& a, double truth, double allowed);

} // namespace scree
