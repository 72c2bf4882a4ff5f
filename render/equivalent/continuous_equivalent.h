#pragma once

#include "render/equivalent/equivalent_form.h"
#include "render/equivalent/mixture_moments.h"
#include "render/equivalent/packing_walk.h"

#include <string>

namespace scree {

/// A homogeneous medium of Henyey-Greenstein scattering that stands for a packing; per the caller's unit of length.
struct ContinuousEquivalent {
    EquivalentForm form = EquivalentForm::plain;
    double sigma_t = 0; ///< achromatic
    V3d albedo{1};
    double g = 0;
    MixtureMoments moments; ///< what the grains do; `moments.phase` goes with the plain form
    double diffusivity = 0; ///< D and l* that the medium has
    double transport_length = 0;
    /// exp(-decay z): how light dies away deep in the medium, per channel.
    V3d decay{0};
    std::string doubt; ///< what was out of a medium's reach, empty if nothing
};

/// The medium of a mixture of grains at a pack rate. walk: in the same unit of length, needed by the forms that use it
/// (throws std::invalid_argument without), and of a world of the same grains. Throws InputError as mixture_moments.
///
/// A walk of point scatterings and exponential flights has D = 1 / (sigma_t^2 (1 - g)) and l* = 1 / (sigma_t (1 - g));
/// hence 1 / sigma_t = D / l*, 1 - g = D / l*^2.
ContinuousEquivalent continuous_equivalent(const MixtureMoments& moments, EquivalentForm form,
                                           const PackingWalk* walk = nullptr);

} // namespace scree
