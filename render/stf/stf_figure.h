#pragma once

#include "base/drawing/picture.h"
#include "render/stf/shell_maps.h"

#include <span>
#include <string>

namespace scree {

/// Draws the directions of light that leaves shells after at least two scatterings, as in Figures 2 and 3 of the
/// supplement of Müller et al. 2016.
///
/// Across are shells of growing radius; down is theta_t, the angle between the light's first direction and the place
/// where it leaves. A disc shows the density per solid angle, from 0 to its peak, over the hemisphere about the shell's
/// normal: sin beta is the distance from the middle, gamma the angle; theta_t grows to the right. A cosine hemisphere
/// is drawn beside the shells.
Picture draw_stf_figure(std::span<const ShellMaps> shells, int width, int height, const std::string& title);

} // namespace scree
