#pragma once

#include "render/bench/half_pictures.h"

#include <array>
#include <cmath>

namespace scree {

/// A number and its standard error.
struct Measured {
    double value = 0, error = 0;
    double factor = 1.96; ///< half width of the 95 % confidence interval in standard errors: larger where the error is
                          ///< estimated from few numbers

    double low() const { return value - factor * error; }
    double high() const { return value + factor * error; }
    /// Whether it is above 0 by more than chance, about three standard errors or more: many such numbers are examined.
    bool is_above_zero() const { return value > 1.5 * factor * error; }
};

inline constexpr int smooth_side = 8; ///< pixels a side of the squares of smooth_bias

/// How a picture differs from a reference.
///
/// All squared errors are means over pixels of the same measure: relative to the reference around a pixel
/// (render/film/relative_error.h), without the pixel itself. If the pixel counted, its noise would be in numerator and
/// denominator, and rare bright samples in the reference would change error and noise in different ways. As it does
/// not, error^2 = noise^2 + bias^2 in the mean.
struct ErrorEstimate {
    Measured noise; ///< variance of the picture
    Measured squared_bias; ///< may be below 0 by chance
    Measured smooth_bias; ///< the same for squares of pixels: shows smaller biases if neighbouring pixels share them
    Measured reference_noise; ///< variance of the reference; its standard error is infinite if it is not known
    Measured squared_error; ///< of the picture against the truth (MRSE): its squared error against the reference minus
                            ///< reference_noise
    std::array<Measured, 3> color; ///< error of the picture's mean, per channel, relative to the reference's mean

    bool knows_reference() const { return std::isfinite(reference_noise.error); }
    /// Whether the error is below the reference's noise, and so not measurable.
    bool is_below_reference() const { return knows_reference() && squared_error.value < reference_noise.value; }
};

/// Separates bias from noise with halves that share no sample.
///
/// For two pictures A and B of one method and a reference R, the mean over pixels of (A - R)(B - R), minus the variance
/// of R, estimates the squared bias, whatever the noise. Standard errors come from the scatter over pixels, which are
/// independent; they include the noise of both pictures. Both pictures have the same size. If the reference's noise is
/// not known, every result from which it should be subtracted has an infinite standard error.
ErrorEstimate estimate_error(const HalfPictures& picture, const HalfPictures& reference);

/// The squared relative error of one picture against the truth: the mean over several pictures, minus the reference's
/// noise.
Measured squared_error(const std::vector<std::vector<V3d>>& pictures, const HalfPictures& reference);

/// The reference's variance over the squared error of one of the pictures: the part of the reference's samples that
/// would give this error. Chance in the reference's noise moves numerator and denominator in opposite directions; the
/// standard error includes this.
Measured part_to_error(const std::vector<std::vector<V3d>>& pictures, const HalfPictures& reference);

} // namespace scree
