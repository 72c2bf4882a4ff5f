#pragma once

#include "base/math.h"
#include "render/media/phase_function.h"

namespace scree {

/// Where a walk through a medium scatters next.
struct MediumEvent {
    bool scattered = false;
    double t = 0; ///< along the ray, if it scattered
    Weight albedo{1}; ///< there: part of the light that is not absorbed
    PhaseFunction phase; ///< there
};

/// One walk for three channels where sigma_t depends on them: it is drawn for one, the hero, and weighed by the
/// one-sample balance heuristic (Wilkie et al. 2014, hero wavelength sampling): a channel counts ratio / mean(ratio).
struct SpectralState {
    uint32_t hero = 0; ///< channel
    Weight ratio{1}; ///< density of this walk, had another channel been the hero, over its density

    void multiply(const Weight& factor)
    {
        constexpr double most =
            1e30; // so much likelier for another hero, a walk counts nothing here; but it stays a number
        for (int c = 0; c < 3; ++c) ratio[c] = std::min(ratio[c] * factor[c], most);
    }
    Weight weight() const { return ratio * (3 / (ratio.x + ratio.y + ratio.z)); }
};

} // namespace scree
