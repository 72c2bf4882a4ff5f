#include "render/bench/suite_report.h"

#include "base/error.h"
#include "render/bench/bench_page.h"
#include "render/bench/bench_report.h"
#include "render/bench/bench_table.h"
#include "render/bench/bench_words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace scree {

namespace {

std::vector<TableRow> all_rows(const SuiteResult& suite)
{
    std::vector<TableRow> rows;
    for (const BenchResult& result : suite.scenes) {
        for (TableRow& row : table_rows(result)) rows.push_back(std::move(row));
    }
    return rows;
}

/// The mean of processor_share over the scenes.
double share_of(const SuiteResult& suite)
{
    double share = 0;
    for (const BenchResult& result : suite.scenes)
        share += result.processor_share() / static_cast<double>(suite.scenes.size());
    return share;
}

std::string machine_line(const SuiteResult& suite)
{
    return fmt::format("{}, times scaled by {:g}; {:.1f} minutes in all",
                       machine_words(suite.scenes.front().machine, share_of(suite)), suite.scale, suite.seconds / 60);
}

} // namespace

std::string suite_table(const SuiteResult& suite) { return machine_line(suite) + "\n" + terminal_table(suite.scenes); }

std::string suite_markdown(const SuiteResult& suite, bool plots)
{
    std::string text = fmt::format("Made by `{}`. {}.\n\n", suite.command, machine_line(suite));
    const auto line = [](const TableRow& row) { return fmt::format("| {} |\n", fmt::join(row, " | ")); };
    text += line(table_head) + line(TableRow(table_head.size(), "---"));
    for (const TableRow& row : all_rows(suite)) text += line(row);
    text += fmt::format("\n{}\n", table_legend);
    if (!plots) return text;
    text += fmt::format("\nPlots: {}\n", plot_legend);
    for (const BenchResult& result : suite.scenes)
        text += fmt::format("\n## {0}\n\n{1}\n\n![error against time of {0}]({0}.svg)\n", result.job.title,
                            scene_words(result));
    return text;
}

std::string suite_page(const SuiteResult& suite)
{
    std::string html =
        page_head("Scree: time against error", fmt::format("{}. {}", suite.command, machine_line(suite)));
    html += page_section("All scenes", table_legend, html_table(table_head, all_rows(suite))) +
            page_section("Convergence", plot_legend, "");
    for (const BenchResult& result : suite.scenes)
        html += page_section(result.job.title, scene_words(result), plot_figure(result));
    return html + page_end();
}

std::string suite_json(const SuiteResult& suite)
{
    nlohmann::json scenes = nlohmann::json::array();
    for (const BenchResult& result : suite.scenes) scenes.push_back(nlohmann::json::parse(json_of(result)));
    const Machine& m = suite.scenes.front().machine;
    return nlohmann::json{{"version", SCREE_VERSION}, {"build", m.build},
                          {"command", suite.command}, {"scale", suite.scale},
                          {"seconds", suite.seconds}, {"threads", m.threads},
                          {"date", m.date},           {"processor_share", share_of(suite)},
                          {"scenes", scenes}}
               .dump(1) +
           "\n";
}

std::string with_block(const std::string& text, const std::string& block, const std::string& file)
{
    const std::string begin = "<!-- scree bench -->", end = "<!-- /scree bench -->";
    const size_t from = text.find(begin), to = text.find(end);
    if (from == std::string::npos || to == std::string::npos || to < from ||
        text.find(begin, from + 1) != std::string::npos || text.find(end, to + 1) != std::string::npos) {
        throw InputError(file, "no place for the numbers", "'" + begin + "' and, after it, '" + end + "', once each",
                         "put both marks where the table should be, each on a line of its own");
    }
    return text.substr(0, from + begin.size()) + "\n" + block + text.substr(to);
}

} // namespace scree
