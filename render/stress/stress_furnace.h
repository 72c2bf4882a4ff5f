#pragma once

#include "render/stress/stress_run.h"

namespace scree {

inline constexpr IntegratorKind all_kinds[] = {IntegratorKind::ept, IntegratorKind::ppt, IntegratorKind::automatic,
                                               IntegratorKind::vpt, IntegratorKind::stf};

/// Rounding of some hundred products of floats.
inline constexpr double furnace_rounding = 1e-5;

/// Renders lossless things in a surrounding of radiance 1, where they are invisible: every pixel with 1. Lights of the
/// scene do not count.
StressFinding furnace(StressScene scene, const StressView& view, const Progress& progress,
                      double allowed = furnace_rounding);

} // namespace scree
