#pragma once

#include "render/medium/homogeneous_medium.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace scree {

/// A closed surface with a medium inside, in render coordinates.
struct MediumRegion {
    std::string name;
    std::vector<V3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles; ///< closed, counter-clockwise from outside
    std::shared_ptr<const HomogeneousMedium> homogeneous;
    bool instead_of_grains = false; ///< the medium stands for the grains in there, which are not met

    bool is_achromatic() const { return homogeneous->is_achromatic(); }
    /// The first scattering in t0 < t < t1 along o + t d.
    MediumEvent event(const V3d&, const V3d&, double t0, double t1, SpectralState& state, Sampler& sampler) const
    {
        return homogeneous->event(t0, t1, state, sampler);
    }
    /// An unbiased estimate of what passes between t0 and t1.
    C3f transmittance(const V3d&, const V3d&, double t0, double t1, Sampler&) const { return homogeneous->transmittance(t1 - t0); }
};

} // namespace scree
