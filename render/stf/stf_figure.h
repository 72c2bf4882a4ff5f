#pragma once

#include "base/drawing/picture.h"
#include "render/stf/shell_maps.h"

#include <span>
#include <string>

namespace scree {

/// Where light goes after two scatterings and more in shells of growing radius (across) by the angle theta_t between
/// its first way and where it leaves (down), as in Figures 2 and 3 of the supplement of Müller et al. 2016; beside them
/// a cosine hemisphere.
///
/// A disc shows the density per solid angle, from 0 to its peak, over the hemisphere about the shell's normal: sin beta
/// is the distance from the middle, gamma the angle; to the right is growing theta_t.
Picture draw_stf_figure(std::span<const ShellMaps> shells, int width, int height, const std::string& title);

} // namespace scree
