#include "render/app/mixture_inputs.h"

#include "base/json.h"
#include "base/text.h"
#include "mixtures/mixture_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace scree {

namespace {

int32_t type_number(const std::string& key, const JsonValue& where)
{
    const auto number = to_int64(key);
    if (!number || *number < std::numeric_limits<int32_t>::min() || *number > std::numeric_limits<int32_t>::max())
        throw InputError(where.place(), "the key '" + key + "'", "a type number of the dump, e.g. \"1\"");
    return static_cast<int32_t>(*number);
}

size_t frame_number(const ParticleSeries& series, int64_t frame, const std::string& dump)
{
    const auto count = static_cast<int64_t>(series.frame_count());
    const int64_t at = frame < 0 ? frame + count : frame;
    if (at < 0 || at >= count)
        throw InputError(dump, fmt::format("--frame {}", frame),
                         fmt::format("one of {} frames, {}..{}", count, -count, count - 1));
    return static_cast<size_t>(at);
}

} // namespace

bool is_scene(const std::filesystem::path& file)
{
    const JsonDocument document = JsonDocument::load(file);
    if (!document.root().is_object()) return false;
    JsonObject root = document.root().object();
    return root.find("grains").has_value();
}

SceneGrains read_scene_grains(const std::filesystem::path& file)
{
    const JsonDocument document = JsonDocument::load(file);
    JsonObject root = document.root().object(), grains = root.require("grains").object();
    SceneGrains scene;
    scene.types = grains.require("types").object().take_keys();
    const auto assembly = grains.find("assembly");
    if (!assembly) return scene;
    JsonObject object = assembly->object();
    if (const auto dump = object.find("dump")) scene.dump = dump->path().string();
    if (const auto types = object.find("types")) {
        JsonObject map = types->object();
        for (const std::string& key : map.take_keys())
            scene.file_types[type_number(key, *types)] = map.require(key).string();
    }
    if (const auto radius = object.find("radius")) {
        if (radius->is_number()) {
            scene.reading.radius = radius->number(0);
        } else {
            JsonObject map = radius->object();
            for (const std::string& key : map.take_keys())
                scene.reading.radius_of_type[type_number(key, *radius)] = map.require(key).number(0);
        }
    }
    return scene;
}

TypedFrame evaluate_mixture(const MixtureDescription& mixture, const std::optional<SceneGrains>& scene,
                            const std::string& dump, const ParticleReadOptions& reading, int64_t frame)
{
    const OpenedParticles opened = open_particles(dump);
    const ParticleSeries& series = *opened.series;
    if (series.frame_count() == 0) throw InputError(dump, "no frames", "a dump with at least one frame");
    const size_t at = frame_number(series, frame, dump);
    TypedFrame result;
    result.frame = series.read(at, reading);
    std::map<int32_t, std::string> file_types;
    if (scene) {
        result.names = scene->types;
        file_types = scene->file_types;
    } else {
        result.names = types_named(mixture);
        if (needs_dump_types(mixture)) {
            // In order of number, and with the same name in every frame.
            const std::set<int32_t> numbers(result.frame.type.begin(), result.frame.type.end());
            for (const int32_t number : numbers) {
                file_types[number] = fmt::format("type {}", number);
                result.names.push_back(file_types[number]);
            }
        }
    }
    MixtureSeries mixtures(mixture, result.names, file_types, dump);
    const auto deciding = mixtures.deciding_frame(series.frame_count());
    if (deciding) mixtures.decide(*deciding == at ? result.frame : series.read(*deciding, reading));
    const auto made = mixtures.mixture(result.frame);
    result.types.resize(result.frame.size());
    for (size_t i = 0; i < result.types.size(); ++i) result.types[i] = made->type(i, result.frame.relative_position(i));
    result.title = fmt::format("{} step {}", series.file(at).filename().string(), series.step(at));
    return result;
}

} // namespace scree
