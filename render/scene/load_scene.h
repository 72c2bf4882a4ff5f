#pragma once

#include "render/scene/scene_description.h"

#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// A value that replaces one of the scene's.
struct SceneOverride {
    std::string path; ///< in the scene, such as camera.fov; a list grows at "film.aov/-"
    std::string json; ///< the value; a bare word is a text
    std::string flag; ///< of the command line, for messages; empty: -D
};

/// A flag of the command line that replaces a value of the scene, as -D does.
struct SceneSwitch {
    std::string flag, help;
    std::string path; ///< of the value in the scene
    std::vector<std::string> (*to_json)(const std::string& text); ///< the text as values

    /// What a text given with the flag replaces. Throws InputError that names the flag.
    std::vector<SceneOverride> overrides(const std::string& text) const;
};

/// Every such flag: those of the integrator, --size and --aov.
const std::vector<SceneSwitch>& scene_switches();

/// What the flag and its text replace; the flag must be one of scene_switches(). Throws InputError.
std::vector<SceneOverride> switch_overrides(const std::string& flag, const std::string& text);

/// Reads a scene file with values replaced: first those that make it another scene (-D), then those that say how it is
/// rendered, which its hash leaves out as the transport plan has one of its own. Throws InputError.
SceneDescription load_scene(const std::filesystem::path& file, const std::vector<SceneOverride>& overrides = {},
                            const std::vector<SceneOverride>& switches = {});

} // namespace scree
