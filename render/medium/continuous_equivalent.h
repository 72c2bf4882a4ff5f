#pragma once

#include "render/medium/mixture_moments.h"
#include "render/medium/packing_walk.h"

#include <string>

namespace scree {

/// How the medium that stands for a packing is found.
///
/// In a bed of white spheres (reflectance 0.9, pack rate 0.6) light from a plane falls off by 0.770 +- 0.002 a radius; the media's by 0.692
/// (plain), 0.691 (formula), 0.833 (walk) and 0.756 +- 0.005 (walk_decay, 600,000 scatterings). Of glass that absorbs 0.05 a radius:
/// 0.1258 +- 0.0002; 0.339, 0.124, 0.120 and 0.1261.
enum class EquivalentForm : uint8_t {
    plain,      ///< the mean flight and the grains' own albedo and phase function; ways within grains are left out
    formula,    ///< keeps transport length and diffusivity of independent flights
    walk,       ///< keeps those of a walk in the packing
    walk_decay, ///< and in each channel how light dies away deep in the packing
};

/// A homogeneous medium of Henyey-Greenstein scattering that stands for a packing; per the caller's unit of length.
struct ContinuousEquivalent {
    EquivalentForm form = EquivalentForm::plain;
    double sigma_t = 0;          ///< achromatic
    V3d albedo{1};
    double g = 0;
    MixtureMoments moments;      ///< what the grains do; `moments.phase` goes with the plain form
    double diffusivity = 0;      ///< D and l* that the medium has
    double transport_length = 0;
    /// exp(-decay z): how light dies away deep in the medium, per channel.
    V3d decay{0};
    std::string doubt;           ///< what was out of a medium's reach, empty if nothing
};

/// The medium of a mixture of grains at a pack rate. walk: in the same unit of length, needed by the forms that use it (throws
/// std::invalid_argument without), and of a world of the same grains. Throws InputError as mixture_moments.
///
/// A walk of point scatterings and exponential flights has D = 1 / (sigma_t^2 (1 - g)) and l* = 1 / (sigma_t (1 - g)); hence
/// 1 / sigma_t = D / l*, 1 - g = D / l*^2.
ContinuousEquivalent continuous_equivalent(const MixtureMoments& moments, EquivalentForm form, const PackingWalk* walk = nullptr);

} // namespace scree
