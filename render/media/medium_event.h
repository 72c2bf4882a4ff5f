#pragma once

#include "base/math.h"
#include "render/media/phase_function.h"

namespace scree {

/// The next scattering of a walk through a medium.
struct MediumEvent {
    bool scattered = false;
    double t = 0; ///< distance along the ray, if it scattered
    Weight albedo{1}; ///< at the scattering: part of the light that is not absorbed
    PhaseFunction phase; ///< there
};

/// State of one walk that serves all three channels, where sigma_t depends on the channel. The walk is sampled for one
/// channel, the hero, and weighted by the one-sample balance heuristic (Wilkie et al. 2014, hero wavelength sampling):
/// the weight of a channel is ratio / mean(ratio).
struct SpectralState {
    uint32_t hero = 0; ///< channel
    /// probability density of this walk if this channel were the hero, over its density for the actual hero
    Weight ratio{1};

    void multiply(const Weight& factor)
    {
        constexpr double most =
            1e30; // At this ratio the hero's own weight is negligible; the limit keeps the numbers finite.
        for (int c = 0; c < 3; ++c) ratio[c] = std::min(ratio[c] * factor[c], most);
    }
    Weight weight() const { return ratio * (3 / (ratio.x + ratio.y + ratio.z)); }
};

} // namespace scree
