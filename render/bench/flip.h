#pragma once

#include "base/math.h"

#include <vector>

namespace scree {

/// A picture for a screen: linear Rec. 709 radiance, which flip_difference clamps to 0..1; rows from the top.
struct ScreenPicture {
    int width = 0, height = 0;
    std::vector<V3d> pixels;
};

/// How different two pictures look to a person who flips between them: one value a pixel, from 0 (the same) to 1.
///
/// Andersson et al. 2020, "FLIP: a difference evaluator for alternating images" (HPG), the form for low dynamic range.
/// pixels_per_degree: of visual angle; 67 is a 0.7 m wide screen of 3840 pixels, seen from 0.7 m. Both pictures have
/// the same size.
std::vector<double> flip_difference(const ScreenPicture& reference, const ScreenPicture& test,
                                    double pixels_per_degree = 67);

/// Mean over all pixels.
double mean_flip(const std::vector<double>& map);

} // namespace scree
