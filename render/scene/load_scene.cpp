#include "render/scene/load_scene.h"

#include "base/error.h"
#include "base/json.h"
#include "base/text.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace scree {

namespace {

constexpr int64_t most_pixels = 65536;

/// A number as JSON writes it, anything else as a text: never null, true or an object.
std::vector<std::string> number_or_text(const std::string& text)
{
    if (const auto number = to_double(text); number && std::isfinite(*number)) return {fmt::format("{}", *number)};
    return {nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
}

std::vector<std::string> on_or_off(const std::string& text)
{
    if (text != "on" && text != "off") throw InputError("--shells", "'" + text + "'", "on or off");
    return {text == "on" ? "true" : "false"};
}

std::vector<std::string> size_json(const std::string& text)
{
    const size_t x = text.find('x');
    const auto width = to_int64(text.substr(0, x));
    const auto height = x == std::string::npos ? std::nullopt : to_int64(text.substr(x + 1));
    if (!width || !height || *width < 1 || *height < 1 || *width > most_pixels || *height > most_pixels)
        throw InputError("--size", "'" + text + "'",
                         fmt::format("WIDTHxHEIGHT, e.g. 640x480, whole numbers in 1..{}", most_pixels));
    return {fmt::format("[{},{}]", *width, *height)};
}

std::vector<std::string> comma_separated(const std::string& text)
{
    std::vector<std::string> words;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, ',');) words.push_back(word);
    return words;
}

} // namespace

std::vector<SceneOverride> SceneSwitch::overrides(const std::string& text) const
{
    std::vector<SceneOverride> replaced;
    for (const std::string& json : to_json(text)) replaced.push_back({path, json, flag});
    return replaced;
}

const std::vector<SceneSwitch>& scene_switches()
{
    static const std::vector<SceneSwitch> switches = [] {
        std::vector<SceneSwitch> all{
            {"--size", "Size of the picture, WIDTHxHEIGHT", "film.size", size_json},
            {"--aov", fmt::format("Additional channels: {}", fmt::join(aov_names.words(), ",")), "film.aov/-",
             comma_separated},
        };
        for (const IntegratorKey& key : integrator_keys()) {
            const bool is_switch = std::string(key.key) == "shells";
            all.push_back(
                {key.flag, key.help, std::string("integrator.") + key.key, is_switch ? on_or_off : number_or_text});
        }
        return all;
    }();
    return switches;
}

std::vector<SceneOverride> switch_overrides(const std::string& flag, const std::string& text)
{
    const auto found = std::ranges::find(scene_switches(), flag, &SceneSwitch::flag);
    if (found == scene_switches().end()) throw InputError(flag, "no such flag", "a flag that replaces a scene's value");
    return found->overrides(text);
}

SceneDescription load_scene(const std::filesystem::path& file, const std::vector<SceneOverride>& overrides,
                            const std::vector<SceneOverride>& switches)
{
    JsonDocument document = JsonDocument::load(file);
    for (const SceneOverride& value : overrides) document.override_value(value.path, value.json, value.flag);
    const std::string canonical = document.canonical();
    for (const SceneOverride& value : switches) {
        try {
            document.override_value(value.path, value.json, value.flag);
        } catch (const InputError&) {
            // The scene has something else than an object or a list there: read_scene() says so, and where.
        }
    }
    SceneDescription scene = read_scene(document, file);
    scene.canonical = canonical;
    return scene;
}

} // namespace scree
