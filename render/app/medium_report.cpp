#include "render/app/medium_report.h"

#include "render/build/grain_medium.h"
#include "render/build/world_builder.h"
#include "render/media/homogeneous_medium.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace scree {

namespace {

using nlohmann::json;

json channels(const V3d& v) { return v.x == v.y && v.x == v.z ? json(v.x) : json{v.x, v.y, v.z}; }

/// The numbers of a homogeneous medium. sigma_t: per render unit; unit: render units a scene unit.
json describe(const V3d& sigma_t, const V3d& albedo, double g, double unit)
{
    const auto over = [&](double factor) {
        V3d length;
        for (int c = 0; c < 3; ++c) length[c] = sigma_t[c] > 0 ? factor / (sigma_t[c] * unit) : 0;
        return channels(length);
    };
    return {{"sigma_t", channels(sigma_t * unit)},
            {"mean_free_path", over(1)},
            {"transport_mean_free_path", over(1 / (1 - g))},
            {"albedo", channels(albedo)},
            {"g", g}};
}

/// Null where there are no grains.
json describe_grains(const World& world, const Progress& progress)
{
    const double unit = world.space.length(1), back = 1 / unit;
    const auto walked = make_grain_medium(world, EquivalentForm::decay, progress);
    if (!walked) return nullptr;
    const MixtureMoments& moments = walked->moments;
    const PackingWalk& walk = *walked->walk;
    const auto measured = [](const Measured& m, double factor) {
        return json{{"value", m.value * factor}, {"standard_error", m.error * factor}};
    };
    json forms;
    for (const auto& [form, name] : medium_form_names) {
        const ContinuousEquivalent medium = continuous_equivalent(moments, form, &walk);
        forms[name] = describe(V3d(medium.sigma_t), medium.albedo, medium.g, unit);
        forms[name]["decay_length"] =
            channels({medium.decay.x > 0 ? back / medium.decay.x : 0, medium.decay.y > 0 ? back / medium.decay.y : 0,
                      medium.decay.z > 0 ? back / medium.decay.z : 0});
        if (!medium.doubt.empty()) forms[name]["doubt"] = medium.doubt;
    }
    return {{"pack_rate", walked->sample.pack_rate},
            {"mean_radius", walked->sample.mean_radius() * back},
            {"volume_weighted_radius", walked->sample.volume_weighted_radius() * back},
            {"void_flight", moments.void_flight * back},
            {"flight", moments.flight * back},
            {"grain_g", moments.g},
            {"grain_albedo", channels(moments.albedo)},
            {"walk",
             {{"pack_rate", walked->pack_rate},
              {"scatterings", walk.scatterings},
              {"seconds", walk.seconds},
              {"void_flight", measured(walk.void_flight, back)},
              {"flight", measured(walk.flight, back)},
              {"cosine", measured(walk.cosine, 1)},
              {"transport_length", measured(walk.transport_length, back)},
              {"diffusivity", measured(walk.diffusivity, back * back)}}},
            {"forms", forms}};
}

std::string number(const json& value)
{
    if (value.is_array())
        return fmt::format("{:.6g} {:.6g} {:.6g}", value[0].get<double>(), value[1].get<double>(),
                           value[2].get<double>());
    return fmt::format("{:.6g}", value.get<double>());
}

std::string text_of_medium(const json& medium, const std::string& indent)
{
    std::string text;
    for (const auto& [key, label] : {std::pair{"sigma_t", "extinction sigma_t"},
                                     {"mean_free_path", "mean free path"},
                                     {"transport_mean_free_path", "transport mean free path"},
                                     {"albedo", "single-scattering albedo"},
                                     {"g", "asymmetry g"},
                                     {"decay_length", "light decays by 1/e over"},
                                     {"largest_sigma_t", "largest sigma_t"}}) {
        if (medium.contains(key)) text += fmt::format("{}{:<26} {}\n", indent, label, number(medium[key]));
    }
    return text;
}

} // namespace

nlohmann::json describe_media(const SceneDescription& scene, size_t frame, const Progress& progress)
{
    SceneDescription described = scene; // with all grains as proxies, and no medium that replaces them yet
    described.integrator.kind = IntegratorKind::ppt;
    described.integrator.explicit_grains = 0;
    described.integrator.grain_depth.reset();
    described.integrator.grain_flights.reset();
    described.integrator.shells = false;
    WorldBuilder builder(described);
    const BuiltFrame built = builder.build(frame, progress);
    const World* const world = built.world.get();
    const double unit = world->space.length(1);
    json media = json::array();
    for (const MediumRegion& region : world->regions) {
        json medium;
        if (const HomogeneousMedium* const uniform = region.medium->uniform()) {
            medium = describe(uniform->sigma_t(), V3d(uniform->albedo()), uniform->phase().mean_cosine(), unit);
        } else {
            const Imath::Box3d box = region.medium->bounds();
            medium["largest_sigma_t"] = region.medium->largest_sigma_t() * unit;
            const V3d lo = box.isEmpty() ? V3d(0) : world->space.world_point(box.min),
                      hi = box.isEmpty() ? V3d(0) : world->space.world_point(box.max);
            medium["box"] = {{lo.x, lo.y, lo.z}, {hi.x, hi.y, hi.z}};
        }
        medium["name"] = region.name;
        media.push_back(medium);
    }
    json description{{"scene", scene.file.string()}, {"media", media}};
    description["grains"] = world->has_grains() ? describe_grains(*world, progress) : json(nullptr);
    description["warnings"] = built.warnings;
    return description;
}

std::string text_of_media(const nlohmann::json& description)
{
    std::string text = description["scene"].get<std::string>() + "\n";
    for (const json& medium : description["media"]) {
        text += fmt::format("  medium '{}'\n", medium["name"].get<std::string>()) + text_of_medium(medium, "    ");
    }
    if (const json& grains = description["grains"]; !grains.is_null()) {
        text += "  grains, as a medium\n";
        for (const auto& [key, label] : {std::pair{"pack_rate", "pack rate"},
                                         {"mean_radius", "mean radius"},
                                         {"volume_weighted_radius", "mean radius by volume"},
                                         {"void_flight", "mean chord of the voids"},
                                         {"flight", "mean path to next scattering"},
                                         {"grain_albedo", "albedo of a grain"},
                                         {"grain_g", "mean cosine of a grain"}}) {
            text += fmt::format("    {:<28} {}\n", label, number(grains[key]));
        }
        const json& walk = grains["walk"];
        if (walk["pack_rate"] != grains["pack_rate"])
            text += fmt::format("    {:<28} {}\n", "pack rate of the walk",
                                number(walk["pack_rate"])); // values above that depend on a pack rate use this one
        for (const auto& [key, label] : {std::pair{"transport_length", "transport length (walk)"},
                                         {"diffusivity", "diffusivity per scattering"}}) {
            text += fmt::format("    {:<28} {:.6g} +- {:.2g}\n", label, walk[key]["value"].get<double>(),
                                walk[key]["standard_error"].get<double>());
        }
        for (const std::string& form : medium_form_names.words()) {
            text += fmt::format("    form {}{}\n", form, form == "decay" ? " (the default)" : "") +
                    text_of_medium(grains["forms"][form], "      ");
            if (grains["forms"][form].contains("doubt"))
                text += "      note: " + grains["forms"][form]["doubt"].get<std::string>() + "\n";
        }
    } else if (description["media"].empty()) {
        text += "  neither media nor grains\n";
    }
    for (const json& warning : description["warnings"]) text += "  note: " + warning.get<std::string>() + "\n";
    return text;
}

} // namespace scree
