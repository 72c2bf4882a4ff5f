#pragma once

#include "render/bench/half_pictures.h"

#include <array>
#include <cmath>

namespace scree {

/// A number and its standard error.
struct Measured {
    double value = 0, error = 0;

    /// The interval that holds the truth 95 times in 100.
    double low() const { return value - 1.96 * error; }
    double high() const { return value + 1.96 * error; }
    /// Whether it is above 0 by more than chance brings: three standard errors, as many of them are looked at.
    bool is_above_zero() const { return value > 3 * error; }
};

inline constexpr int smooth_side = 8; ///< pixels: of the squares of smooth_bias

/// What parts a picture from a reference. Squared errors are relative, means over pixels (render/film/relative_error.h).
struct ErrorEstimate {
    Measured noise;           ///< variance of the picture
    Measured squared_bias;    ///< may be below 0 by chance
    Measured smooth_bias;     ///< the same of squares of pixels: smaller biases show, where they are alike over a square
    Measured reference_noise; ///< variance of the reference
    Measured squared_error;   ///< of the picture against the truth (MRSE): that against the reference, less the reference's noise
    std::array<Measured, 3> color; ///< of the picture's mean, per channel, relative to that of the reference

    /// Whether the picture is nearer to the truth than the reference may be.
    bool is_below_reference() const { return squared_error.value < reference_noise.value; }
};

/// Tells bias from noise by halves that share no sample.
///
/// Of pictures A, B of one method and a reference R, the mean over pixels of (A - R)(B - R), less the variance of R, is the squared
/// bias, whatever the noise. Standard errors are by the scatter over pixels, which are independent of each other. Relative to the
/// reference around a pixel, without the pixel itself, as its noise would be in both factors. Both of one size. Where nothing is known
/// of the reference's noise the standard error of a bias is infinite. Noise and error are relative to the pixel itself, as MRSE is
/// defined: where a reference has rare bright samples they come out too large.
ErrorEstimate estimate_error(const HalfPictures& picture, const HalfPictures& reference);

/// The squared relative error of one estimate of the picture (as half a alone), less the reference's noise.
Measured squared_error(const std::vector<V3d>& picture, const HalfPictures& reference);

} // namespace scree
