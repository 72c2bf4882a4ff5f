#include "render/app/option_values.h"

#include "base/error.h"

#include <CLI/CLI.hpp>

namespace scree {

void add_override_option(CLI::App& command, std::vector<SceneOverride>& overrides)
{
    const auto take = [&overrides](const std::vector<std::string>& items) {
        for (const std::string& item : items) {
            const size_t equals = item.find('=');
            if (equals == std::string::npos || equals == 0)
                throw InputError("-D", "'" + item + "'", "key=value, e.g. camera.fov=40");
            overrides.push_back({item.substr(0, equals), item.substr(equals + 1), ""});
        }
    };
    command.add_option_function<std::vector<std::string>>("-D", take, "Replace a value of the scene: -D camera.fov=40");
}

void add_scene_switch(CLI::App& command, const SceneSwitch& scene_switch, std::vector<SceneOverride>& switches)
{
    const auto take = [&switches, scene_switch](const std::string& text) {
        for (const SceneOverride& value : scene_switch.overrides(text)) switches.push_back(value);
    };
    command.add_option_function<std::string>(scene_switch.flag, take, scene_switch.help)->join(',');
}

} // namespace scree
