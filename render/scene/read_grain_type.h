#pragma once

#include "base/json.h"
#include "render/scene/scene_description.h"

namespace scree {

/// A grain type from its JSON object (keys: render/scene/scene.schema.json). A shape of the library brings its own
/// material, with absorption per unit of length of the scene, unless the object has a material. Throws InputError.
GrainTypeDescription read_grain_type(const std::string& name, const JsonValue& json, double metres_per_unit);

/// Metres per unit of length: a number above 0, or "m", "cm", "mm", "um".
double read_unit(const JsonValue& json);

} // namespace scree
