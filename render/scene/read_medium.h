#pragma once

#include "base/json.h"
#include "render/scene/scene_description.h"

namespace scree {

/// A medium from its JSON object (keys: render/scene/scene.schema.json). Throws InputError.
MediumDescription read_medium(const JsonValue& json);

} // namespace scree
