#include "render/loop/job_report.h"

#include "base/work_meter.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace scree {

namespace {

std::string bytes_text(uint64_t bytes)
{
    if (bytes < 10000) return fmt::format("{} B", bytes);
    if (bytes < 10000000) return fmt::format("{:.1f} kB", static_cast<double>(bytes) * 1e-3);
    return fmt::format("{:.1f} MB", static_cast<double>(bytes) * 1e-6);
}

std::string part_text(const PartReport& part)
{
    std::string text = fmt::format("  {:<8} {:<26} {}", part.built ? "built" : "skipped", part.part, part.reason);
    if (part.built && (part.bytes > 0 || part.seconds > 0))
        text += part.bytes > 0 ? fmt::format(" ({}, {:.3f} s)", bytes_text(part.bytes), part.seconds)
                               : fmt::format(" ({:.3f} s)", part.seconds);
    return text + "\n";
}

double per_second(uint64_t n, double seconds) { return seconds > 0 ? static_cast<double>(n) / seconds : 0; }

const char* kind_name(HitKind kind)
{
    switch (kind) {
    case HitKind::none: return "nothing";
    case HitKind::grain: return "grain";
    case HitKind::surface: return "surface";
    case HitKind::light: return "light";
    case HitKind::medium: return "medium";
    }
    return "";
}

} // namespace

std::vector<PartReport> all_parts(const SceneDescription& scene, const BuiltFrame& built, bool is_cropped)
{
    const TransportPlan& plan = built.plan;
    const World& world = *built.world;
    const std::string why_proxies = fmt::format("after {} grains of a path", plan.explicit_grains);
    const std::string why_none =
        !plan.has_grains || plan.replaces_all ? plan.why : "every grain is traced as explicit geometry";
    std::vector<PartReport> parts{{"explicit grains", plan.has_exemplars(), plan.why},
                                  {"proxies", plan.has_proxies(), plan.has_proxies() ? why_proxies : why_none}};
    parts.insert(parts.end(), built.parts.begin(), built.parts.end());

    if (is_cropped) { // grains outside the crop shade and light those inside, so a list keeps them
        const std::string part = "grains outside the crop";
        if (!plan.has_grains || plan.replaces_all)
            parts.push_back({part, false, plan.why});
        else if (world.fill)
            parts.push_back({part, false, "no grain is listed: rays find the grains they hit"});
        else
            parts.push_back({part, true, "kept: they may scatter light into the crop"});
    }
    // The same condition as in the tracer; grains that a medium is to replace may still be in the world.
    const bool enters = plan.needs_gsdfs() || std::ranges::any_of(world.types, [](const GrainType& type) {
                            return type.material.transmits();
                        });
    const bool cut = enters && world.has_grains() && !plan.replaces_all && !world.surfaces.empty();
    parts.push_back({"surfaces inside grains", cut,
                     cut ? "a second structure of the surfaces, for grains they cut through"
                         : "no path inside a grain can hit a surface"});
    const bool sampled = world.lights.any_sampled();
    const char* found = world.lights.lights().empty() ? "the scene has no light"
                                                      : "only constant or black lights, which need no sampling";
    parts.push_back(
        {"light sampling", sampled, sampled ? "next-event estimation with multiple importance sampling" : found});
    for (const auto& [aov, name] : aov_names) {
        const bool wanted = std::ranges::find(scene.film.aov, aov) != scene.film.aov.end();
        parts.push_back({"channels " + name, wanted, wanted ? "asked for" : "not asked for"});
    }
    return parts;
}

std::string plan_text(const SceneDescription& scene, const BuiltFrame& built, size_t frame_count, bool is_cropped)
{
    const World& world = *built.world;
    std::string text = fmt::format("{}: {}x{}, integrator {}", scene.file.string(), scene.film.width, scene.film.height,
                                   integrator_names[scene.integrator.kind]);
    if (scene.integrator.kind == IntegratorKind::automatic)
        text += fmt::format(", accuracy {}", accuracy_names[scene.integrator.accuracy]);
    text += built.name.empty() ? "\n" : fmt::format(", frame {} of {}: {}\n", built.frame, frame_count, built.name);
    for (const PartReport& part : all_parts(scene, built, is_cropped)) text += part_text(part);
    text += part_text({"acceleration structure", true, "to be built by Embree"});
    const bool none_traced = built.plan.replaces_all;
    text += fmt::format("  would trace {}{}{} grains of {} types among {} surfaces and {} media under {} lights\n",
                        none_traced ? "a medium in place of " : "", world.fill ? "about " : "", world.grain_count(),
                        world.types.size(), world.surfaces.size(), world.regions.size(), world.lights.lights().size());
    return text;
}

std::string statistics_text(const FrameReport& report)
{
    const RenderStatistics& s = report.statistics;
    std::string text = fmt::format("frame {} {}: {} grains\n", report.frame, report.name, report.grains);
    for (const PartReport& part : report.parts) text += part_text(part);
    text += fmt::format("  set up in {:.2f} s, rendered in {:.2f} s: {} samples a pixel, {} paths\n",
                        report.setup_seconds, s.seconds, s.spp, s.paths);
    if (s.error) {
        text += fmt::format("  relative error {:.3g} (worst tile: {:.3g}), {:.1f} samples a pixel on average\n",
                            s.error->picture, s.error->worst_tile, s.mean_spp);
    }
    text +=
        fmt::format("  {} segments ({:.3f} million a second), {} shadow rays, {:.2f} segments a path, longest {}\n",
                    s.segments, 1e-6 * per_second(s.segments, s.seconds), s.shadow_rays,
                    static_cast<double>(s.segments) / static_cast<double>(std::max<uint64_t>(1, s.paths)), s.longest);
    if (s.events > 0)
        text += fmt::format("  {} scatterings in media ({:.3f} million a second)\n", s.events,
                            1e-6 * per_second(s.events, s.seconds));
    if (s.shells > 0)
        text +=
            fmt::format("  {} shells ({:.3f} million a second)\n", s.shells, 1e-6 * per_second(s.shells, s.seconds));
    text += fmt::format("  {} samples not finite, {} rays lost between triangles, peak memory {}\n", s.non_finite,
                        s.leaks, bytes_text(peak_bytes()));
    return text;
}

std::string statistics_json(const std::vector<FrameReport>& reports, const std::string& integrator)
{
    using nlohmann::json;
    json frames = json::array();
    for (const FrameReport& report : reports) {
        const RenderStatistics& s = report.statistics;
        json parts = json::array();
        for (const PartReport& part : report.parts) {
            parts.push_back({{"part", part.part},
                             {"built", part.built},
                             {"reason", part.reason},
                             {"seconds", part.seconds},
                             {"bytes", part.bytes}});
        }
        frames.push_back({{"frame", report.frame},
                          {"particles", report.name},
                          {"grains", report.grains},
                          {"parts", parts},
                          {"setup_seconds", report.setup_seconds},
                          {"render_seconds", s.seconds},
                          {"spp", s.spp},
                          {"paths", s.paths},
                          {"segments", s.segments},
                          {"shadow_rays", s.shadow_rays},
                          {"medium_events", s.events},
                          {"shells", s.shells},
                          {"longest_path", s.longest},
                          {"segments_per_second", per_second(s.segments, s.seconds)},
                          {"non_finite", s.non_finite},
                          {"leaks", s.leaks},
                          {"mean_spp", s.mean_spp},
                          {"cut", s.cut},
                          {"stopped", s.stopped},
                          {"cancelled", s.cancelled},
                          {"timed_out", s.timed_out}});
        if (s.error) {
            frames.back()["relative_error"] = s.error->picture;
            frames.back()["worst_tile_error"] = s.error->worst_tile;
            frames.back()["error_reached"] = s.error_reached;
        }
    }
    return json{{"version", SCREE_VERSION},
                {"integrator", integrator},
                {"peak_memory_bytes", peak_bytes()},
                {"frames", frames}}
               .dump(2) +
           "\n";
}

std::string debug_text(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter,
                       const SamplePlace& place, const RenderOptions& options)
{
    flush_subnormals();
    std::vector<PathVertex> trail;
    const PathResult result =
        render_sample(world, tracer, camera, filter, place.x, place.y, place.sample, options, &trail);
    std::string text =
        fmt::format("pixel {},{} sample {}: radiance {} {} {}, {} segments\n", place.x, place.y, place.sample,
                    result.radiance.x, result.radiance.y, result.radiance.z, result.segments);
    for (size_t i = 0; i < trail.size(); ++i) {
        const PathVertex& v = trail[i];
        const V3d o = world.space.world_point(v.o), p = world.space.world_point(v.hit.point);
        text += fmt::format("{:4} from ({:.9g} {:.9g} {:.9g}) along ({:.6f} {:.6f} {:.6f}){} meets {}", i, o.x, o.y,
                            o.z, v.d.x, v.d.y, v.d.z, v.inside ? " inside" : "", kind_name(v.hit.place.kind));
        if (v.hit.place.kind == HitKind::grain) {
            text += fmt::format(" id {} type {}", world.id(v.hit.place.index), world.types[v.hit.place.type].name);
        } else if (v.hit.place.kind == HitKind::surface) {
            text += " " + world.surfaces[v.hit.place.index].name;
        }
        if (v.hit.place.kind != HitKind::none) text += fmt::format(" at ({:.9g} {:.9g} {:.9g})", p.x, p.y, p.z);
        text += fmt::format("; weight {:.6g} {:.6g} {:.6g}, radiance {:.6g} {:.6g} {:.6g}\n", v.weight.x, v.weight.y,
                            v.weight.z, v.radiance.x, v.radiance.y, v.radiance.z);
    }
    return text;
}

} // namespace scree
