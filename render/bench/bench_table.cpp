#include "render/bench/bench_table.h"

#include "base/text_table.h"
#include "render/bench/bench_words.h"
#include "render/bench/flip.h"

#include <fmt/format.h>

#include <array>

namespace scree {

std::vector<TableRow> table_rows(const BenchResult& result)
{
    const ReferencePicture& r = result.reference;
    std::vector<TableRow> rows{{result.job.title, "reference", r.name, r.samples > 0 ? std::to_string(r.samples) : "-",
                                "-", r.processor_seconds > 0 ? seconds_words(r.processor_seconds) : "-", "-", "-",
                                noise_words(result), "-", "-", "-", "-",
                                r.picture.halved ? fmt::format("{:.3f}", result.reference_flip) : "-", "-"}};
    for (const MethodResult& m : result.methods) {
        const RenderStatistics& s = m.statistics;
        const ErrorEstimate& e = m.estimate;
        rows.push_back({result.job.title, m.name, m.plan, std::to_string(m.samples), setup_words(m.setup),
                        seconds_words(m.time.processor), seconds_words(m.time_to_unit_variance()),
                        gain_words(result, m), root_words(e.noise.value), error_words(e), bias_words(e.squared_bias),
                        bias_words(e.smooth_bias), colors_words(e.color), flip_words(result, mean_flip(m.flip)),
                        count_words(rate(s.segments + s.shadow_rays + s.events + s.shells, m))});
    }
    return rows;
}

std::string terminal_table(const std::vector<BenchResult>& results)
{
    constexpr std::array wide{14, 12, 11, 5, 3, 2}; // columns only for the page, from the last to the first
    const auto narrow = [&](TableRow row) {
        for (const int c : wide) row.erase(row.begin() + c);
        return row;
    };
    std::vector<TableRow> rows{narrow(table_head)};
    for (const BenchResult& result : results) {
        for (TableRow& row : table_rows(result)) {
            rows.push_back(narrow(row));
            if (row[1] != "reference") rows.back()[0] = "";
        }
    }
    std::string text = text_table(rows);
    for (const BenchResult& result : results) {
        for (const std::string& note : result.notes) text += fmt::format("  {}: note: {}\n", result.job.title, note);
        for (const MethodResult& m : result.methods) {
            for (const std::string& warning : m.warnings)
                text += fmt::format("  {}, {}: note: {}\n", result.job.title, m.name, warning);
            if (m.statistics.non_finite > 0)
                text += fmt::format("  {}, {}: {} samples were not finite and are left out\n", result.job.title, m.name,
                                    m.statistics.non_finite);
        }
    }
    return text;
}

} // namespace scree
