#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace scree {

/// How a walk through a shell is taken, each but the last a further approximation of the one before (Müller et al.
/// 2016, section 5).
enum class StfForm : uint8_t {
    full, ///< records: place, direction and scatterings of whole walks
    cosine, ///< after two scatterings and more the direction is drawn by its cosine to the normal, whatever the place
    hg, ///< and the walks are those of Henyey and Greenstein's phase function of the same mean cosine
    interpolated, ///< and the shell is as large as fits, its walks those of the table's radii below and above
    diffusion ///< what scatters at all as from an isotropic source in a diffusing ball: uniform over the shell, cosine
              ///< about its normal (in the manner of Meng et al. 2015)
};
inline const std::vector<std::string> stf_form_names{"full", "cosine", "hg", "interpolated", "diffusion"};

} // namespace scree
