#pragma once

#include "base/render_space.h"
#include "render/lights/light.h"
#include "render/scene/scene_description.h"

#include <memory>

namespace scree {

/// A light in render coordinates. map: of an environment light; read separately because frames share it.
Light make_light(const LightDescription& description, const std::shared_ptr<const EnvironmentMap>& map,
                 const RenderSpace& space);

} // namespace scree
