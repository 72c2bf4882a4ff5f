#pragma once

#include "base/progress.h"
#include "render/scene/scene_description.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace scree {

/// What the media of a scene are, the medium that stands for its grains included; lengths in the unit of the scene.
/// frame: of the grains.
///
/// Throws InputError, Cancelled.
nlohmann::json describe_media(const SceneDescription& scene, size_t frame, const Progress& progress);

/// The same for people.
std::string text_of_media(const nlohmann::json& description);

} // namespace scree
