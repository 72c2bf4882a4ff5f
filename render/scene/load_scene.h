#pragma once

#include "render/scene/scene_description.h"

#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// A value that replaces a value of the scene.
struct SceneOverride {
    std::string path; ///< in the scene, such as camera.fov; "film.aov/-" appends to a list
    std::string json; ///< the value; a bare word is a string
    std::string flag; ///< the command-line flag, for messages; empty: -D
};

/// A command-line flag that replaces a value of the scene, as -D does.
struct SceneSwitch {
    std::string flag, help;
    std::string path; ///< of the value in the scene
    std::vector<std::string> (*to_json)(const std::string& text); ///< the JSON values of the flag's text

    /// The values that the flag replaces when given `text`. Throws InputError that names the flag.
    std::vector<SceneOverride> overrides(const std::string& text) const;
};

/// All such flags: --size, --aov and those of the integrator.
const std::vector<SceneSwitch>& scene_switches();

/// The values that `flag`, one of scene_switches(), replaces when given `text`. Throws InputError.
std::vector<SceneOverride> switch_overrides(const std::string& flag, const std::string& text);

/// Reads a scene file and replaces values: first `overrides` (-D), which make it another scene, then `switches`, which
/// say how to render it. The scene's hash leaves out the switches: the transport plan has its own hash. Throws
/// InputError.
SceneDescription load_scene(const std::filesystem::path& file, const std::vector<SceneOverride>& overrides = {},
                            const std::vector<SceneOverride>& switches = {});

} // namespace scree
