#pragma once

#include "base/enum_names.h"

#include <cstdint>

namespace scree {

/// How the medium that replaces the grains of a packing is computed.
enum class EquivalentForm : uint8_t {
    plain, ///< from the mean flight, and the grains' own albedo and phase function; paths inside grains are ignored
    formula, ///< keeps the transport length and the diffusivity, taking flights as independent (design, section 4)
    walk, ///< keeps those that a walk in the packing measures
    decay, ///< the same, and in each channel the decay of light deep in the packing: sigma_t carries that of the
           ///< brightest channel, the albedos those of the others
};
inline const EnumNames<EquivalentForm> medium_form_names{{EquivalentForm::plain, "plain"},
                                                         {EquivalentForm::formula, "formula"},
                                                         {EquivalentForm::walk, "walk"},
                                                         {EquivalentForm::decay, "decay"}};

/// Whether the form needs a walk in the packing.
inline bool needs_walk(EquivalentForm form) { return form == EquivalentForm::walk || form == EquivalentForm::decay; }

} // namespace scree
