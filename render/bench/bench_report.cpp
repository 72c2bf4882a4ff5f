#include "render/bench/bench_report.h"

#include "render/bench/bench_words.h"
#include "render/bench/flip.h"
#include "render/bench/text_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace scree {

namespace {

using nlohmann::json;

json measured(const Measured& m) { return {{"value", m.value}, {"standard_error", m.error}, {"low", m.low()}, {"high", m.high()}}; }
json work(const WorkTime& t) { return {{"wall_seconds", t.wall}, {"processor_seconds", t.processor}}; }

json method_json(const MethodResult& m, const BenchResult& result)
{
    const ErrorEstimate& e = m.estimate;
    const RenderStatistics& s = m.statistics;
    json points = json::array();
    for (const ConvergencePoint& p : m.points) {
        points.push_back({{"wall_seconds", p.time.wall}, {"processor_seconds", p.time.processor}, {"spp", p.samples},
                          {"squared_error", measured(p.squared_error)}, {"below_reference_noise", p.below_reference}});
    }
    json colors = json::object();
    for (size_t c = 0; c < 3; ++c) colors[std::string(1, "rgb"[c])] = measured(e.color[c]);
    return {{"method", m.name}, {"integrator", m.plan}, {"grains", m.grains}, {"peak_memory_bytes", m.memory},
            {"seconds", {{"read", m.setup.read}, {"precompute", m.setup.precompute}, {"build", m.setup.build}, {"render", m.time.wall}}},
            {"render", work(m.time)}, {"spp", m.samples}, {"paths", s.paths}, {"segments", s.segments}, {"shadow_rays", s.shadow_rays},
            {"medium_events", s.events}, {"shells", s.shells}, {"longest_path", s.longest}, {"non_finite", s.non_finite}, {"leaks", s.leaks},
            {"segments_per_processor_second", rate(s.segments, m)}, {"events_per_processor_second", rate(s.events, m)}, {"shells_per_processor_second", rate(s.shells, m)},
            {"noise", measured(e.noise)}, {"squared_bias", measured(e.squared_bias)}, {"bias_measured", e.squared_bias.is_above_zero()},
            {"squared_bias_of_squares", measured(e.smooth_bias)}, {"bias_of_squares_measured", e.smooth_bias.is_above_zero()},
            {"mrse", measured(e.squared_error)}, {"below_reference_noise", e.is_below_reference() && result.reference.picture.has_noise()},
            {"time_to_unit_variance", m.time_to_unit_variance()}, {"color_error", colors}, {"flip", mean_flip(m.flip)}, {"convergence", points}, {"warnings", m.warnings}};
}

} // namespace

std::string table_of(const BenchResult& result)
{
    std::string text = fmt::format("{}: {}x{}, frame {}, {} seeds; {}\n", result.title, result.width(), result.height(), result.frame, result.seeds, machine_words(result.machine));
    if (!result.methods.empty()) {
        const ReferencePicture& r = result.reference;
        const std::string noise = r.picture.has_noise() ? root_words(result.methods.front().estimate.reference_noise.value) : "not known";
        text += fmt::format("  reference: {}, {} samples a pixel, {} of processors; its noise {}{}\n", r.name, r.samples, seconds_words(r.processor_seconds), noise,
                            r.picture.halved ? fmt::format(", FLIP of its halves {:.3f}", result.reference_flip) : "");
    }
    std::vector<std::vector<std::string>> rows{{"method", "spp", "set up", "processors", "noise", "unit var.", "error", "bias (95 %)", "bias of 8x8", "mean colour R G B, %", "FLIP", "rays/s", "events/s", "shells/s", "memory"}};
    for (const MethodResult& m : result.methods) {
        const RenderStatistics& s = m.statistics;
        const ErrorEstimate& e = m.estimate;
        const auto per_second = [&](uint64_t n) { return n > 0 ? count_words(rate(n, m)) : "-"; };
        rows.push_back({m.name, std::to_string(m.samples), seconds_words(m.setup.read + m.setup.precompute + m.setup.build), seconds_words(m.time.processor),
                        root_words(e.noise.value), seconds_words(m.time_to_unit_variance()), error_words(e), bias_words(e.squared_bias), bias_words(e.smooth_bias),
                        colors_words(e.color),
                        fmt::format("{:.3f}", mean_flip(m.flip)), per_second(s.segments + s.shadow_rays), per_second(s.events), per_second(s.shells), bytes_words(m.memory)});
    }
    text += text_table(rows);
    for (const MethodResult& m : result.methods) {
        for (const std::string& warning : m.warnings) text += fmt::format("  {}: note: {}\n", m.name, warning);
        if (m.statistics.non_finite > 0) text += fmt::format("  {}: {} samples were not finite and are left out\n", m.name, m.statistics.non_finite);
    }
    return text;
}

std::string json_of(const BenchResult& result)
{
    const ReferencePicture& r = result.reference;
    json methods = json::array();
    for (const MethodResult& m : result.methods) methods.push_back(method_json(m, result));
    json reference{{"name", r.name}, {"spp", r.samples}, {"processor_seconds", r.processor_seconds}, {"noise_known", r.picture.has_noise()}, {"flip_of_halves", result.reference_flip}};
    if (!result.methods.empty()) reference["noise"] = measured(result.methods.front().estimate.reference_noise);
    const Machine& m = result.machine;
    return json{{"version", SCREE_VERSION}, {"title", result.title}, {"scene", result.scene}, {"scene_hash", fmt::format("{:016x}", result.scene_hash)}, {"frame", result.frame},
                {"size", {result.width(), result.height()}}, {"seeds", result.seeds}, {"peak_memory_bytes", result.peak_memory},
                {"machine", {{"processor", m.processor}, {"cores", m.cores}, {"threads", m.threads}, {"date", m.date}}}, {"reference", reference}, {"methods", methods}}
               .dump(2) + "\n";
}

} // namespace scree
