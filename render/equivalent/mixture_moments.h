#pragma once

#include "render/equivalent/grain_moments.h"

#include <optional>
#include <span>

namespace scree {

/// Grains of one type and radius in a mixture.
struct GrainShare {
    const Gsdf* gsdf = nullptr;
    const GrainMoments* moments = nullptr; ///< moments of the GSDF; null: computed
    Material material; ///< absorption per the caller's unit of length
    double radius = 1; ///< of the bounding sphere, in the caller's unit of length
    double number = 1; ///< number of these grains, relative to the other shares
    std::optional<GrainAlbedo> albedo = {}; ///< albedo at this radius; nullopt: computed
};

/// Moments of a random walk of light in a packing, from scattering to scattering, with independent flights; in the
/// caller's unit of length.
///
/// Scatterings are weighted by cross-section, n r^2 (1 - alpha0). Flights in the voids are assumed exponential; for a
/// grain that is passed straight through, its chord and a further flight are added.
struct MixtureMoments {
    double void_flight = 0; ///< l_v = 4 (1 - f) <r^3> / (3 f <r^2>), exact for any packing
    double flight = 0, flight2 = 0; ///< mean and mean square of the distance from scattering to scattering
    double g = 0; ///< mean cosine
    double along_in = 0, along_out = 0, delta2 = 0; ///< moments of the displacement within grains, as in GrainMoments
    V3d albedo{1}; ///< mean weight of a scattering
    V3d weighted_cosine{0};
    CosineTable phase;

    /// Transport length, the mean distance along the initial direction until the direction is forgotten: l* = (l + a) /
    /// (1 - g), with l = flight, a = along_in.
    double transport_length() const { return (flight + along_in) / (1 - g); }
    /// D = lim <x^2> / (2 n) after n scatterings: (m2 + 2 l a + <delta^2>) / 2 + (l g + b) (l + a) / (1 - g), with m2 =
    /// flight2, b = along_out.
    double diffusivity() const;
};

/// The moments of a mixture. fraction: part of the volume that the bounding spheres fill, in (0, 1). Throws InputError
/// for other fractions, for invalid shares, and if nothing scatters.
MixtureMoments mixture_moments(std::span<const GrainShare> shares, double fraction);

} // namespace scree
