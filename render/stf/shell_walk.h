#pragma once

#include "base/sampler.h"
#include "render/stf/shell_sampler.h"

#include <span>

namespace scree {

/// One lossless walk from a shell's centre to its surface.
struct ShellWalk {
    ShellExit exit; ///< exit.events 0: it went straight through
    ShellEvent event; ///< one of its scatterings, drawn by closeness
    double event_sum = 0; ///< sum of the closeness of all its scatterings
};

/// Walks in a shell of `radius` mean free paths. smaller: shells that the walk may use, of albedo 1 and ascending
/// radius; if empty, every scattering is simulated.
ShellWalk walk_in_shell(const PhaseFunction& phase, double radius, std::span<const ShellSampler> smaller,
                        Sampler& sampler);

} // namespace scree
