#pragma once

#include "base/json.h"
#include "render/scene/scene_description.h"

namespace scree {

/// A medium from its JSON object (render/scene/scene.schema.json says what it may hold). Throws InputError.
MediumDescription read_medium(const JsonValue& json);

} // namespace scree
