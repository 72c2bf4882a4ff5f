#pragma once

#include "render/equivalent/equivalent_form.h"
#include "render/scene/accuracy.h"
#include "render/stf/stf_form.h"

#include <cstdint>
#include <optional>

namespace scree {

class JsonValue;

enum class IntegratorKind : uint8_t { automatic, ept, ppt, vpt, stf };
inline const EnumNames<IntegratorKind> integrator_names{{IntegratorKind::automatic, "auto"},
                                                        {IntegratorKind::ept, "ept"},
                                                        {IntegratorKind::ppt, "ppt"},
                                                        {IntegratorKind::vpt, "vpt"},
                                                        {IntegratorKind::stf, "stf"}};

/// The scene's "integrator" as given by the file and the command line. plan_transport() decides what it means for the
/// scene's grains; it chooses absent values by the kind and the accuracy.
struct IntegratorDescription {
    IntegratorKind kind = IntegratorKind::automatic;
    Accuracy accuracy = Accuracy::standard;
    uint32_t max_depth = 0; ///< scattering events after which a path is cut; 0: never
    std::optional<uint32_t> explicit_grains; ///< auto and ppt: grains of a path traced as explicit geometry
    std::optional<double>
        grain_pixels; ///< auto and ppt: if a path's first grain looks narrower (pixels), all are proxies
    std::optional<double> grain_depth; ///< mean radii: depth below every face from which a medium replaces the grains
    std::optional<double> grain_flights; ///< that depth is no fewer mean free paths of that medium
    EquivalentForm medium_form = EquivalentForm::decay;
    std::optional<bool> shells; ///< whether light crosses media in shells
    StfForm stf_form = StfForm::full;
    std::optional<double> least_shell; ///< mean free paths: a medium whose largest shell is smaller gets no shells
};

/// One value of the scene's "integrator": its key, and the command-line flag that replaces it.
struct IntegratorKey {
    const char* key;
    const char* flag;
    const char* help;
    void (*read)(const JsonValue& value, IntegratorDescription& integrator); ///< throws InputError
};

/// Every key, one row each: a new switch of an integrator starts here.
const std::vector<IntegratorKey>& integrator_keys();

/// Throws InputError.
IntegratorDescription read_integrator(const JsonValue& json);

} // namespace scree
