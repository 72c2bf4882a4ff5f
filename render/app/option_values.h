#pragma once

#include "render/scene/load_scene.h"

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace scree {

/// Adds -D key=value, which replaces a value of the scene.
void add_override_option(CLI::App& command, std::vector<SceneOverride>& overrides);

/// Adds a flag of scene_switches(): what is given with it goes to `switches`.
void add_scene_switch(CLI::App& command, const SceneSwitch& scene_switch, std::vector<SceneOverride>& switches);

} // namespace scree
