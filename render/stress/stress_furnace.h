#pragma once

#include "render/stress/stress_run.h"

namespace scree {

inline constexpr IntegratorKind all_kinds[] = {IntegratorKind::ept, IntegratorKind::ppt, IntegratorKind::automatic,
                                               IntegratorKind::vpt, IntegratorKind::stf};

/// Rounding of some hundred float products.
inline constexpr double furnace_rounding = 1e-5;

/// Renders lossless objects in surroundings of radiance 1, where they are invisible, and compares every pixel with 1.
/// Replaces the lights of the scene.
StressFinding furnace(StressScene scene, const StressView& view, const Progress& progress,
                      double allowed = furnace_rounding);

} // namespace scree
