#include "render/bench/suite_report.h"

#include "ingest/support/error.h"
#include "render/bench/bench_page.h"
#include "render/bench/bench_report.h"
#include "render/bench/bench_words.h"
#include "render/bench/flip.h"
#include "render/bench/text_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace scree {

namespace {

using Row = std::vector<std::string>;

const Row head{"scene", "method", "does", "set up", "unit variance", "against ept", "noise", "error", "bias (95 %)", "bias of 8x8", "colour", "FLIP", "rays + events/s"};

/// How many times sooner than ept a method brings its variance to the same.
std::string gain_words(const MethodResult& method, const BenchResult& result)
{
    for (const MethodResult& other : result.methods) {
        if (other.name != "ept" || method.time_to_unit_variance() <= 0) continue;
        return &other == &method ? "1" : fmt::format("{:.2g} x", other.time_to_unit_variance() / method.time_to_unit_variance());
    }
    return "-";
}

/// The mean colour's error in the channel where it is largest against chance.
std::string worst_color_words(const ErrorEstimate& estimate)
{
    const auto z = [](const Measured& m) { return m.error > 0 ? std::abs(m.value) / m.error : 0; };
    const Measured* worst = &estimate.color[0];
    for (const Measured& m : estimate.color)
        if (z(m) > z(*worst)) worst = &m;
    return color_words(*worst);
}

std::vector<Row> rows_of(const BenchResult& result)
{
    std::vector<Row> rows;
    for (const MethodResult& m : result.methods) {
        const RenderStatistics& s = m.statistics;
        rows.push_back({result.title, m.name, m.plan, seconds_words(m.setup.read + m.setup.precompute + m.setup.build), seconds_words(m.time_to_unit_variance()), gain_words(m, result),
                        root_words(m.estimate.noise.value), error_words(m.estimate), bias_words(m.estimate.squared_bias), bias_words(m.estimate.smooth_bias), worst_color_words(m.estimate), fmt::format("{:.3f}", mean_flip(m.flip)),
                        count_words(rate(s.segments + s.shadow_rays + s.events + s.shells, m))});
    }
    return rows;
}

std::vector<Row> all_rows(const std::vector<BenchResult>& results)
{
    std::vector<Row> rows;
    for (const BenchResult& result : results) {
        for (Row& row : rows_of(result)) rows.push_back(std::move(row));
    }
    return rows;
}

constexpr const char* about = "Unit variance: processor time until the relative variance is 1; against ept: how many times sooner than by tracing every grain. Errors are relative, root mean square. "
                              "A bias no larger than chance brings is not measured, with the most that it may be; of means of squares of 8x8 pixels smaller ones can be. Colour: error of the picture's mean in the worst channel, with one standard error.";

std::string machine_line(const std::vector<BenchResult>& results, double seconds)
{
    return fmt::format("{}; {:.1f} minutes in all", results.empty() ? "" : machine_words(results.front().machine), seconds / 60);
}

} // namespace

std::string suite_table(const std::vector<BenchResult>& results, double seconds)
{
    std::vector<Row> rows = all_rows(results);
    for (size_t i = rows.size(); i-- > 1;)
        if (rows[i][0] == rows[i - 1][0]) rows[i][0] = "";
    rows.insert(rows.begin(), head);
    return machine_line(results, seconds) + "\n" + text_table(rows);
}

std::string suite_markdown(const std::vector<BenchResult>& results, double seconds, bool plots)
{
    std::string text = machine_line(results, seconds) + ".\n\n";
    const auto line = [](const Row& row) { return fmt::format("| {} |\n", fmt::join(row, " | ")); };
    text += line(head) + line(Row(head.size(), "---"));
    for (const Row& row : all_rows(results)) text += line(row);
    text += fmt::format("\n{}\n", about);
    if (!plots) return text;
    for (const BenchResult& result : results) {
        text += fmt::format("\n## {0}\n\n{1}x{2}, reference by {3}, {4} samples a pixel\n\n![error against time of {0}]({0}.svg)\n", result.title, result.width(), result.height(),
                            result.reference.name, result.reference.samples);
    }
    return text;
}

std::string suite_page(const std::vector<BenchResult>& results, double seconds)
{
    std::string html = page_head("Scree: time against error", machine_line(results, seconds));
    html += page_section("All scenes", about, html_table(head, all_rows(results)));
    for (const BenchResult& result : results) {
        html += page_section(result.title, fmt::format("{}, frame {}, {}x{}, {} seeds; reference: {}, {} samples a pixel", result.scene, result.frame, result.width(), result.height(), result.seeds,
                                                       result.reference.name, result.reference.samples),
                             "<div class=\"plots\"><figure>" + svg_of(convergence_plot(result)) + "</figure></div>\n");
    }
    return html + page_end();
}

std::string suite_json(const std::vector<BenchResult>& results, double seconds)
{
    nlohmann::json scenes = nlohmann::json::array();
    for (const BenchResult& result : results) scenes.push_back(nlohmann::json::parse(json_of(result)));
    return nlohmann::json{{"version", SCREE_VERSION}, {"seconds", seconds}, {"scenes", scenes}}.dump(1) + "\n";
}

std::string with_block(const std::string& text, const std::string& block, const std::string& file)
{
    const std::string begin = "<!-- scree bench -->", end = "<!-- /scree bench -->";
    const size_t from = text.find(begin), to = text.find(end);
    if (from == std::string::npos || to == std::string::npos || to < from || text.find(begin, from + 1) != std::string::npos || text.find(end, to + 1) != std::string::npos) {
        throw InputError(file, "no place for the numbers", "'" + begin + "' and, after it, '" + end + "', once each", "put both, on lines of their own, where the table shall stand");
    }
    return text.substr(0, from + begin.size()) + "\n" + block + text.substr(to);
}

} // namespace scree
