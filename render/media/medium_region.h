#pragma once

#include "render/media/grid_medium.h"
#include "render/media/homogeneous_medium.h"

#include <Imath/ImathBox.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace scree {

class MediumShells;

/// A closed surface with a medium inside, in render coordinates.
struct MediumRegion {
    std::string name;
    std::vector<V3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles; ///< closed, counter-clockwise from outside
    std::shared_ptr<const HomogeneousMedium> homogeneous; ///< this,
    std::shared_ptr<const GridMedium> grid; ///< or this
    std::shared_ptr<const MediumShells> shells; ///< that light may go through in there, or null
    bool instead_of_grains = false; ///< the medium stands for the grains in there, which are not met

    Imath::Box3d bounds() const
    {
        Imath::Box3d box;
        for (const V3f& p : positions) box.extendBy(V3d(p));
        return box;
    }
    bool is_achromatic() const { return homogeneous ? homogeneous->is_achromatic() : grid->is_achromatic(); }
    /// The first scattering in t0 < t < t1 along o + t d.
    MediumEvent event(const V3d& o, const V3d& d, double t0, double t1, SpectralState& state, Sampler& sampler) const
    {
        return homogeneous ? homogeneous->event(t0, t1, state, sampler) : grid->event(o, d, t0, t1, state, sampler);
    }
    /// An unbiased estimate of what passes between t0 and t1.
    Color transmittance(const V3d& o, const V3d& d, double t0, double t1, Sampler& sampler) const
    {
        return homogeneous ? homogeneous->transmittance(t1 - t0) : grid->transmittance(o, d, t0, t1, sampler);
    }
};

} // namespace scree
