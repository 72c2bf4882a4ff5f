#include "render/bench/bench_page.h"

#include "render/bench/bench_maps.h"
#include "render/bench/bench_table.h"
#include "render/bench/bench_words.h"
#include "render/bench/flip.h"

#include <fmt/format.h>

namespace scree {

namespace {

constexpr const char* style = R"(
body { font: 15px/1.5 system-ui, "Segoe UI", Roboto, sans-serif; color: #1d2733; background: #f4f6f8; margin: 0; }
main { max-width: 1280px; margin: 0 auto; padding: 28px 20px 60px; }
h1 { font-size: 26px; margin: 0 0 2px; } h2 { font-size: 18px; margin: 0 0 6px; }
.below { color: #5a6775; margin: 0 0 18px; overflow-wrap: anywhere; }
section { background: #fff; border: 1px solid #dde3e9; border-radius: 8px; padding: 18px 20px;
  margin: 0 0 16px; overflow-x: auto; }
p { margin: 4px 0 10px; max-width: 90ch; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin: 6px 0 10px; font-size: 13px; }
td, th { text-align: right; padding: 4px 0 4px 11px; white-space: nowrap; font-weight: normal; }
td:first-child, th:first-child { text-align: left; padding-left: 0; font-weight: 600; }
thead th { color: #5a6775; border-bottom: 1px solid #dde3e9; vertical-align: bottom; }
tbody tr + tr td { border-top: 1px solid #edf0f3; }
.pictures { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: 14px; margin: 0 0 18px; }
figure { margin: 0; } figure img { width: 100%; height: auto; image-rendering: auto;
  display: block; border-radius: 3px; }
figcaption { font-size: 13px; color: #34414f; margin: 3px 0 0; }
.plots { display: flex; flex-wrap: wrap; gap: 20px; } .plots figure { flex: 1 1 480px; max-width: 620px; }
.note { color: #5a6775; }
@media print { body { background: #fff; } section { break-inside: avoid; } }
)";

std::string figure(const BenchResult& result, const std::vector<float>& rgb, const std::string& caption)
{
    if (rgb.empty()) return "";
    return fmt::format(
        "<figure><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\"/><figcaption>{}</figcaption></figure>\n",
        png_address(result.width(), result.height(), rgb), result.width(), result.height(), xml_escaped(caption),
        xml_escaped(caption));
}

std::string cost_section(const BenchResult& result)
{
    std::vector<TableRow> rows;
    for (const MethodResult& m : result.methods) {
        const RenderStatistics& s = m.statistics;
        const auto per_second = [&](uint64_t n) { return n > 0 ? count_words(rate(n, m)) : "-"; };
        rows.push_back({m.name, m.plan, seconds_words(m.setup.read), seconds_words(m.setup.precompute),
                        seconds_words(m.setup.build), setup_words(m.setup), seconds_words(m.time.wall),
                        seconds_words(m.time.processor), bytes_words(m.memory), per_second(s.paths),
                        per_second(s.segments + s.shadow_rays), per_second(s.events), per_second(s.shells)});
    }
    return page_section(
        "Cost",
        fmt::format("Rates are per second of processor time. Memory is the peak of a method's set-up minus the memory "
                    "used before it; the peak of the whole program was {}. "
                    "Read, precompute and build are wall-clock times. Data in a cache are read, not computed again.",
                    bytes_words(result.peak_memory)),
        html_table({"method", "integrator", "read", "precompute", "build", "set up (processors)", "render (clock)",
                    "render (processors)", "memory", "paths/s", "rays/s", "events/s", "shells/s"},
                   rows));
}

std::string picture_section(const BenchResult& result)
{
    const HalfPictures& reference = result.reference.picture;
    std::string html = "<div class=\"pictures\">\n" +
                       figure(result, shown(reference), fmt::format("Reference: {}", result.reference.name)) +
                       "</div>\n";
    for (const MethodResult& m : result.methods) {
        html += "<div class=\"pictures\">\n" +
                figure(result, shown(m.picture), fmt::format("{}: {} samples a pixel", m.name, m.samples));
        html += figure(result, shown_flip(m.flip),
                       fmt::format("{}: FLIP, mean {}", m.name, flip_words(result, mean_flip(m.flip))));
        html +=
            figure(result, shown_bias(m.picture, reference), fmt::format("{}: difference in standard errors", m.name)) +
            "</div>\n";
    }
    return page_section("Pictures",
                        fmt::format("FLIP: from black (no visible difference when flipping between the pictures) to "
                                    "pale yellow (1); its mean between the two halves of the reference is {:.3f}. "
                                    "Differences: blue where the picture is darker than the reference, red where it is "
                                    "brighter, in squares of {} pixels a side, full colour at {} standard errors; "
                                    "without bias the map is pale and has no pattern.",
                                    result.reference_flip, bias_square, bias_range),
                        html);
}

} // namespace

Plot convergence_plot(const BenchResult& result)
{
    Plot plot;
    plot.title = "Error against time: " + result.job.title;
    plot.x_label = "processor time of one picture, s";
    plot.y_label = "relative error";
    plot.log_x = plot.log_y = true;
    for (const MethodResult& m : result.methods) {
        PlotSeries line{m.name, PlotSeries::Style::line, {}, {}, {}, {}};
        for (const ConvergencePoint& p : m.points) {
            line.x.push_back(p.time.processor);
            line.y.push_back(p.squared_error.value > 0 ? std::sqrt(p.squared_error.value) : 0);
            line.hollow.push_back(p.below_reference);
        }
        plot.series.push_back(std::move(line));
    }
    if (std::isfinite(result.reference_noise.error))
        plot.marks.push_back({std::sqrt(std::max(0.0, result.reference_noise.value)), "noise of the reference", true});
    return plot;
}

std::string plot_figure(const BenchResult& result)
{
    return "<div class=\"plots\"><figure>" + svg_of(convergence_plot(result)) + "</figure></div>\n";
}

std::string page_head(const std::string& title, const std::string& below)
{
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n<meta "
                       "charset=\"utf-8\"/>\n"
                       "<meta name=\"viewport\" content=\"width=device-width, "
                       "initial-scale=1\"/>\n<title>{0}</title>\n<style>{2}</style>\n</head>\n<body>\n<main>\n"
                       "<h1>{0}</h1>\n<p class=\"below\">{1}</p>\n",
                       xml_escaped(title), xml_escaped(below), style);
}

std::string html_table(const TableRow& head, const std::vector<TableRow>& rows)
{
    std::string html = "<table>\n<thead><tr>";
    for (const std::string& cell : head) html += "<th>" + xml_escaped(cell) + "</th>";
    html += "</tr></thead>\n<tbody>\n";
    for (const TableRow& row : rows) {
        html += "<tr>";
        for (const std::string& cell : row) html += "<td>" + xml_escaped(cell) + "</td>";
        html += "</tr>\n";
    }
    return html + "</tbody>\n</table>\n";
}

std::string page_section(const std::string& title, const std::string& about, const std::string& inside)
{
    return fmt::format("<section>\n<h2>{}</h2>\n<p class=\"note\">{}</p>\n{}</section>\n", xml_escaped(title),
                       xml_escaped(about), inside);
}

std::string page_end() { return "</main>\n</body>\n</html>\n"; }

std::string page_of(const BenchResult& result)
{
    std::string notes;
    for (const std::string& note : result.notes) notes += "<p>" + xml_escaped(note) + "</p>\n";
    return page_head(result.job.title,
                     scene_words(result) + ". " + machine_words(result.machine, result.processor_share())) +
           page_section("Error", table_legend, notes + html_table(table_head, table_rows(result))) +
           page_section("Convergence", plot_legend, plot_figure(result)) + cost_section(result) +
           picture_section(result) + page_end();
}

} // namespace scree
