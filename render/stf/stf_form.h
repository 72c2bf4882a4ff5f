#pragma once

#include "base/enum_names.h"

#include <cstdint>

namespace scree {

/// How light crosses a shell (Müller et al. 2016, section 5). Each form but the last approximates the one before it.
enum class StfForm : uint8_t {
    full, ///< records of whole walks: place, direction and number of scatterings (the paper's 4D STF)
    cosine, ///< after two or more scatterings the direction is cosine-distributed about the normal (the paper's 2D STF)
    hg, ///< the same, with walks of a Henyey-Greenstein phase function of equal mean cosine
    interpolated, ///< the same, and the shell is as large as fits: walks are drawn from the two nearest tabulated radii
    diffusion ///< the baseline of Meng et al. 2015: light that scatters leaves uniformly over the shell,
              ///< cosine-distributed
};
inline const EnumNames<StfForm> stf_form_names{{StfForm::full, "full"},
                                               {StfForm::cosine, "cosine"},
                                               {StfForm::hg, "hg"},
                                               {StfForm::interpolated, "interpolated"},
                                               {StfForm::diffusion, "diffusion"}};

} // namespace scree
