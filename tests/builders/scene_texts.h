#pragma once

#include "base/json.h"
#include "render/scene/scene_description.h"

#include <string>

namespace scree::test {

// Texts of scene files, read as if they lay in /scenes/here.

inline SceneDescription read(const std::string& text)
{
    return read_scene(JsonDocument::parse(text, "scene.json", "/scenes/here"), "/scenes/here/scene.json");
}

inline const std::string camera = R"("camera": {"origin": [0, -10, 2], "target": [0, 0, 1]})";
inline SceneDescription read_with(const std::string& keys) { return read("{" + camera + ", " + keys + "}"); }

inline const std::string clay = R"("clay": {"shape": "sphere", "material": {"kind": "lambert"}})";
inline const std::string stone = R"("stone": {"shape": {"mesh": "stone.ply"}, "material": {"kind": "lambert"}})";

} // namespace scree::test
