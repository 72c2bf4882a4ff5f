#pragma once

#include "base/sampler.h"
#include "render/media/medium_event.h"

#include <Imath/ImathBox.h>

#include <cstdint>

namespace scree {

class HomogeneousMedium;

/// A participating medium, of whatever kind; safe to use from many threads. A new kind implements this.
///
/// All places, directions and lengths are in render coordinates; directions have length 1; t1 may be infinite.
class Medium {
public:
    virtual ~Medium() = default;

    /// The first scattering in t0 < t < t1 along o + t d.
    virtual MediumEvent event(const V3d& o, const V3d& d, double t0, double t1, SpectralState& state,
                              Sampler& sampler) const = 0;
    /// An unbiased estimate of the transmittance per channel between t0 and t1, in 0..1.
    virtual Color transmittance(const V3d& o, const V3d& d, double t0, double t1, Sampler& sampler) const = 0;

    /// Whether sigma_t is the same for all channels everywhere: event() then leaves the SpectralState alone.
    virtual bool is_achromatic() const = 0;
    /// This medium, if it is the same everywhere; null if it varies.
    virtual const HomogeneousMedium* uniform() const { return nullptr; }

    virtual Color sigma_t(const V3d& p) const = 0; ///< extinction coefficient
    virtual Weight albedo(const V3d& p) const = 0;
    virtual double g(const V3d& p) const = 0; ///< mean cosine of the phase function
    virtual double largest_sigma_t() const = 0; ///< of any channel, anywhere
    virtual double voxel() const = 0; ///< length below which nothing varies; infinite where nothing does
    /// A box around everything that is not empty; empty when nothing is.
    virtual Imath::Box3d bounds() const = 0;
    virtual uint64_t bytes() const = 0; ///< of memory
};

} // namespace scree
