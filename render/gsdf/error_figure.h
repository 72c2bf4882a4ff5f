#pragma once

#include "base/drawing/picture.h"
#include "render/gsdf/map_errors.h"

#include <string>

namespace scree {

/// Colour of a relative error: black at 1 % and below, through purple and orange to pale yellow at 1000 % and above,
/// logarithmic. The scale is the same in every figure.
ScreenColor error_color(double relative);

/// Draws the error maps of a grain as in Figures 5 to 32 of the supplement of Müller et al. 2016: one sheet for forward
/// scattering (omega_i on the side of n_o) and one for backward scattering.
///
/// Rows are cos beta_o, columns gamma_o. A disc shows sin beta_i as the distance from its middle and gamma_i as the
/// angle, counter-clockwise from the right. The colour is |p - p_true| over the mean density, with p as in
/// ScatteringMap. The lines of `caption` are drawn below.
Picture draw_error_figure(const ScatteringMap& gsdf, const ScatteringMap& truth, int width, int height,
                          const std::string& title, const std::vector<std::string>& caption);

} // namespace scree
