#pragma once

#include "base/json.h"
#include "render/scene/scene_description.h"

namespace scree {

/// A grain type from its JSON object (render/scene/scene.schema.json says what it may hold). A shape of the library
/// brings its material, per unit of length of the scene, unless there is another. Throws InputError.
GrainTypeDescription read_grain_type(const std::string& name, const JsonValue& json, double metres_per_unit);

/// Metres per unit of length: a number above 0, or "m", "cm", "mm", "um".
double read_unit(const JsonValue& json);

} // namespace scree
