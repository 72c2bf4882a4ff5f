#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace scree {

/// How the medium that stands for a packing is found.
enum class EquivalentForm : uint8_t {
    plain, ///< the mean flight and the grains' own albedo and phase function; ways within grains are left out
    formula, ///< keeps transport length and diffusivity of independent flights
    walk, ///< keeps those of a walk in the packing
    decay, ///< and in each channel how light dies away deep in the packing: sigma_t gives it to the brightest, albedos
           ///< to the others
};
/// Whether it follows from a walk in the packing.
inline bool needs_walk(EquivalentForm form) { return form == EquivalentForm::walk || form == EquivalentForm::decay; }
inline const std::vector<std::string> medium_form_names{"plain", "formula", "walk", "decay"};

} // namespace scree
