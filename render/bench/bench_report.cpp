#include "render/bench/bench_report.h"

#include "render/bench/bench_words.h"
#include "render/bench/flip.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace scree {

namespace {

using nlohmann::json;

json measured(const Measured& m)
{
    return {{"value", m.value}, {"standard_error", m.error}, {"low", m.low()}, {"high", m.high()}};
}
json work(const WorkTime& t) { return {{"wall_seconds", t.wall}, {"processor_seconds", t.processor}}; }

json method_json(const MethodResult& m, const BenchResult& result)
{
    const ErrorEstimate& e = m.estimate;
    const RenderStatistics& s = m.statistics;
    const std::optional<Measured> gain = result.gain(m);
    json points = json::array();
    for (const ConvergencePoint& p : m.points) {
        points.push_back({{"wall_seconds", p.time.wall},
                          {"processor_seconds", p.time.processor},
                          {"spp", p.samples},
                          {"squared_error", measured(p.squared_error)},
                          {"below_reference_noise", p.below_reference}});
    }
    json colors = json::object();
    for (size_t c = 0; c < 3; ++c) colors[std::string(1, "rgb"[c])] = measured(e.color[c]);
    return {{"method", m.name},
            {"integrator", m.plan},
            {"grains", m.grains},
            {"peak_memory_bytes", m.memory},
            {"seconds",
             {{"read", m.setup.read},
              {"precompute", m.setup.precompute},
              {"build", m.setup.build},
              {"render", m.time.wall}}},
            {"set_up", work(m.setup.all)},
            {"from_cache", m.setup.cached},
            {"render", work(m.time)},
            {"spp", m.samples},
            {"paths", s.paths},
            {"segments", s.segments},
            {"shadow_rays", s.shadow_rays},
            {"medium_events", s.events},
            {"shells", s.shells},
            {"longest_path", s.longest},
            {"non_finite", s.non_finite},
            {"leaks", s.leaks},
            {"segments_per_processor_second", rate(s.segments, m)},
            {"events_per_processor_second", rate(s.events, m)},
            {"shells_per_processor_second", rate(s.shells, m)},
            {"noise", measured(e.noise)},
            {"squared_bias", measured(e.squared_bias)},
            {"bias_measured", e.squared_bias.is_above_zero()},
            {"squared_bias_of_squares", measured(e.smooth_bias)},
            {"bias_of_squares_measured", e.smooth_bias.is_above_zero()},
            {"mrse", measured(e.squared_error)},
            {"below_reference_noise", e.is_below_reference()},
            {"time_to_unit_variance", m.time_to_unit_variance()},
            {"gain_over_ept", gain ? measured(*gain) : json()},
            {"color_error", colors},
            {"flip", mean_flip(m.flip)},
            {"convergence", points},
            {"warnings", m.warnings}};
}

} // namespace

std::string json_of(const BenchResult& result)
{
    const ReferencePicture& r = result.reference;
    const BenchJob& job = result.job;
    json methods = json::array(), overrides = json::object();
    for (const MethodResult& m : result.methods) methods.push_back(method_json(m, result));
    for (const SceneOverride& value : job.scene.overrides) overrides[value.path] = value.json;
    const json reference{{"name", r.name},
                         {"spp", r.samples},
                         {"processor_seconds", r.processor_seconds},
                         {"noise_known", r.picture.has_noise()},
                         {"noise", measured(result.reference_noise)},
                         {"flip_of_halves", result.reference_flip},
                         {"key", r.key}};
    const json asked{{"seed", job.scene.options.seed},
                     {"seconds", job.seconds},
                     {"reference_seconds", job.reference_seconds},
                     {"reference_method", job.reference_method.name},
                     {"reference_file", job.reference.string()},
                     {"replaced", overrides}};
    const Machine& m = result.machine;
    return json{{"version", SCREE_VERSION},
                {"title", job.title},
                {"scene", job.scene.scene.string()},
                {"scene_hash", fmt::format("{:016x}", result.scene_hash)},
                {"frame", job.frame},
                {"size", {result.width(), result.height()}},
                {"seeds", job.seeds},
                {"job", asked},
                {"peak_memory_bytes", result.peak_memory},
                {"notes", result.notes},
                {"machine",
                 {{"processor", m.processor},
                  {"cores", m.cores},
                  {"threads", m.threads},
                  {"date", m.date},
                  {"build", m.build},
                  {"processor_share", result.processor_share()}}},
                {"reference", reference},
                {"methods", methods}}
               .dump(2) +
           "\n";
}

} // namespace scree
