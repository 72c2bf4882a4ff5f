#pragma once

#include "render/equivalent/equivalent_form.h"
#include "render/equivalent/mixture_moments.h"
#include "render/equivalent/packing_walk.h"

#include <string>

namespace scree {

/// A homogeneous medium with a Henyey-Greenstein phase function that replaces a packing; in the caller's unit of
/// length.
struct ContinuousEquivalent {
    EquivalentForm form = EquivalentForm::plain;
    double sigma_t = 0; ///< achromatic
    V3d albedo{1};
    double g = 0;
    /// moments of the grains' scattering; `moments.phase` is the phase function of the plain form
    MixtureMoments moments;
    double diffusivity = 0; ///< D of the medium
    double transport_length = 0;
    /// Deep in the medium light decays as exp(-decay z), per channel.
    V3d decay{0};
    std::string doubt; ///< which property no medium could match; empty if all are matched
};

/// The equivalent medium of a mixture of grains at a pack rate. walk: a walk among the same grains, in the same unit of
/// length; required by the forms for which needs_walk() is true (else throws std::invalid_argument).
///
/// A walk with point scatterings and exponential flights has D = 1 / (sigma_t^2 (1 - g)) and l* = 1 / (sigma_t (1 -
/// g)); hence 1 / sigma_t = D / l* and 1 - g = D / l*^2.
ContinuousEquivalent continuous_equivalent(const MixtureMoments& moments, EquivalentForm form,
                                           const PackingWalk* walk = nullptr);

} // namespace scree
