#include "render/bench/stress/stress_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace scree {

void StressFinding::count(const RenderStatistics& statistics)
{
    paths += statistics.paths;
    segments += statistics.segments;
    non_finite += statistics.non_finite;
    leaks += statistics.leaks;
    stopped += statistics.stopped;
    longest = std::max<uint64_t>(longest, statistics.longest);
    if (statistics.first_non_finite && remark.empty()) {
        const SamplePlace& p = *statistics.first_non_finite;
        remark = fmt::format("first not finite: pixel {},{} sample {}", p.x, p.y, p.sample);
    }
}

bool StressReport::passed() const
{
    for (const StressFamily& family : families) {
        for (const StressCase& c : family.cases) {
            if (!c.passed()) return false;
        }
    }
    return true;
}

std::string stress_text(const StressReport& report)
{
    size_t done = 0, failed = 0;
    uint64_t non_finite = 0;
    std::string text = fmt::format("{:<50} {:>9} {:>9} {:<9} {:>7} {:>7} {:>7}\n", "case", "deviation", "allowed", "unit", "sees", "dropped", "seconds");
    for (const StressFamily& family : report.families) {
        if (family.cases.empty()) continue;
        text += fmt::format("\n{}: {}\n  allowed: {}\n", family.name, family.compared, family.why);
        for (const StressCase& c : family.cases) {
            const StressFinding& f = c.finding;
            const std::string sees = f.sees > 0 ? fmt::format("{:.2g} %", 100 * f.sees) : "any";
            text += fmt::format("  {:<48} {:>9.3g} {:>9.3g} {:<9} {:>7} {:>7} {:>7.1f} {}\n", c.name, f.deviation, f.allowed, f.unit, sees, f.non_finite, c.seconds,
                                c.passed() ? "pass" : "FAIL");
            if (!c.error.empty()) text += "      " + c.error + "\n";
            if (f.stopped > 0) text += fmt::format("      {} paths did not end in time\n", f.stopped);
            if (!f.remark.empty()) text += "      " + f.remark + "\n";
            ++done;
            failed += !c.passed();
            non_finite += f.non_finite;
        }
    }
    return text + fmt::format("\n{} of {} cases pass, {} samples not finite, {:.0f} s\n", done - failed, done, non_finite, report.seconds);
}

nlohmann::json stress_json(const StressReport& report)
{
    nlohmann::json families = nlohmann::json::array();
    for (const StressFamily& family : report.families) {
        nlohmann::json cases = nlohmann::json::array();
        for (const StressCase& c : family.cases) {
            const StressFinding& f = c.finding;
            cases.push_back({{"name", c.name}, {"passed", c.passed()}, {"deviation", f.deviation}, {"allowed", f.allowed}, {"unit", f.unit},
                             {"least_seen", f.sees}, {"remark", f.remark}, {"error", c.error}, {"seconds", c.seconds}, {"paths", f.paths},
                             {"segments", f.segments}, {"non_finite", f.non_finite}, {"stopped", f.stopped}, {"leaks", f.leaks}, {"longest_path", f.longest}});
        }
        families.push_back({{"name", family.name}, {"compared", family.compared}, {"why_allowed", family.why}, {"cases", cases}});
    }
    return {{"passed", report.passed()}, {"seconds", report.seconds}, {"families", families}};
}

} // namespace scree
