#pragma once

#include "render/bench/flip.h"
#include "render/bench/half_pictures.h"

#include <string>
#include <vector>

namespace scree {

/// A picture as flip_difference takes it; radiance: in place of the whole.
ScreenPicture screen_picture(const HalfPictures& picture);
ScreenPicture screen_picture(const HalfPictures& picture, const std::vector<V3d>& radiance);

/// Pictures to look at: 3 values a pixel, 0 to 1, as the screen shows them, rows from the top.
std::vector<float> shown(const HalfPictures& picture);
/// Differences 0 to 1 from black to pale yellow.
std::vector<float> shown_flip(const std::vector<double>& map);
/// Where a picture is darker (blue) or brighter (red) than the reference, in standard errors of the difference, in
/// squares of bias_square pixels; white where there is none, full colour at bias_range. Empty where the noise of one of
/// them is not known.
std::vector<float> shown_bias(const HalfPictures& picture, const HalfPictures& reference);
inline constexpr int bias_square = 4;
inline constexpr double bias_range = 5;

/// A picture inside a page: the address of a PNG that stands in the address itself (RFC 2397).
std::string png_address(int width, int height, const std::vector<float>& rgb);

} // namespace scree
