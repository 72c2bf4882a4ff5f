#pragma once

#include "base/progress.h"
#include "render/scene/scene_description.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace scree {

/// The properties of the media of a scene and of the medium that represents its grains; lengths in the unit of the
/// scene. frame: of the grains.
///
/// Throws InputError, Cancelled.
nlohmann::json describe_media(const SceneDescription& scene, size_t frame, const Progress& progress);

/// The same as text for people.
std::string text_of_media(const nlohmann::json& description);

} // namespace scree
