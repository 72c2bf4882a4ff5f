#pragma once

#include "render/bench/flip.h"
#include "render/bench/half_pictures.h"

#include <string>
#include <vector>

namespace scree {

/// A picture in the form that flip_difference takes. radiance: replaces the mean of the picture's halves.
ScreenPicture screen_picture(const HalfPictures& picture);
ScreenPicture screen_picture(const HalfPictures& picture, const std::vector<V3d>& radiance);

/// A picture for the screen: 3 sRGB values (0 to 1) a pixel, rows from the top. The next two have the same format.
std::vector<float> shown(const HalfPictures& picture);
/// A FLIP map for the screen: from black (0) to pale yellow (1).
std::vector<float> shown_flip(const std::vector<double>& map);
/// Shows where a picture is darker (blue) or brighter (red) than the reference, in squares of bias_square pixels a
/// side.
///
/// White: no difference; full colour: bias_range standard errors of the difference. Empty if the noise of either
/// picture is not known.
std::vector<float> shown_bias(const HalfPictures& picture, const HalfPictures& reference);
inline constexpr int bias_square = 4;
inline constexpr double bias_range = 5;

/// A picture as a data URL: a PNG embedded in the page (RFC 2397).
std::string png_address(int width, int height, const std::vector<float>& rgb);

} // namespace scree
