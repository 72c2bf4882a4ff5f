#pragma once

#include "render/bench/half_pictures.h"

#include <array>
#include <cmath>

namespace scree {

/// A number and its standard error.
struct Measured {
    double value = 0, error = 0;
    double factor = 1.96; ///< of the standard error in the interval that holds the truth 95 times in 100: larger where
                          ///< the error is by few numbers

    double low() const { return value - factor * error; }
    double high() const { return value + factor * error; }
    /// Whether it is above 0 by more than chance brings: three standard errors or more, as many of them are looked at.
    bool is_above_zero() const { return value > 1.5 * factor * error; }
};

inline constexpr int smooth_side = 8; ///< pixels: of the squares of smooth_bias

/// What parts a picture from a reference.
///
/// All squared errors are means over pixels of one measure: relative to the reference around a pixel
/// (render/film/relative_error.h), without the pixel itself. Its own noise would be in both, and rare bright samples
/// that the reference happened to meet, or not, would tell on error and noise in different ways. So error^2 = noise^2 +
/// bias^2 in the mean.
struct ErrorEstimate {
    Measured noise; ///< variance of the picture
    Measured squared_bias; ///< may be below 0 by chance
    Measured smooth_bias; ///< the same of squares of pixels: smaller biases show, where they are alike over a square
    Measured reference_noise; ///< variance of the reference; of infinite standard error where it is not known
    Measured squared_error; ///< of the picture against the truth (MRSE): that against the reference, less the
                            ///< reference's noise
    std::array<Measured, 3> color; ///< of the picture's mean, per channel, relative to that of the reference

    bool knows_reference() const { return std::isfinite(reference_noise.error); }
    /// Whether the picture is nearer to the truth than the reference may be.
    bool is_below_reference() const { return knows_reference() && squared_error.value < reference_noise.value; }
};

/// Tells bias from noise by halves that share no sample.
///
/// Of pictures A, B of one method and a reference R, the mean over pixels of (A - R)(B - R), less the variance of R, is
/// the squared bias, whatever the noise. Standard errors are by the scatter over pixels, which are independent of each
/// other; they hold the noise of both pictures. Both of one size. Where nothing is known of the reference's noise, what
/// it would be taken off from has an infinite standard error.
ErrorEstimate estimate_error(const HalfPictures& picture, const HalfPictures& reference);

/// The squared relative error of one picture, as the mean over several of them, less the reference's noise.
Measured squared_error(const std::vector<std::vector<V3d>>& pictures, const HalfPictures& reference);

/// The reference's variance over the squared error of one of the pictures: the part of the reference's samples that
/// reaches it. What of the reference's noise is chance tells in both, against each other; the standard error holds
/// that.
Measured part_to_error(const std::vector<std::vector<V3d>>& pictures, const HalfPictures& reference);

} // namespace scree
