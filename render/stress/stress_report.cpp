#include "render/stress/stress_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace scree {

void StressFinding::count(const RenderStatistics& statistics)
{
    paths += statistics.paths;
    segments += statistics.segments;
    events += statistics.events;
    shells += statistics.shells;
    non_finite += statistics.non_finite;
    leaks += statistics.leaks;
    stopped += statistics.stopped;
    longest = std::max<uint64_t>(longest, statistics.longest);
    if (statistics.first_non_finite && remark.empty()) {
        const SamplePlace& p = *statistics.first_non_finite;
        remark = fmt::format("first not finite: pixel {},{} sample {}", p.x, p.y, p.sample);
    }
}

double StressFinding::length() const
{
    return static_cast<double>(segments + events + shells) / static_cast<double>(std::max<uint64_t>(1, paths));
}

bool StressFinding::passed() const
{
    return deviation <= allowed && sees <= must_see && non_finite == 0 && stopped == 0 && length() >= least_length &&
           static_cast<double>(leaks) <= may_leak * static_cast<double>(paths);
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

namespace {

/// The worst case of a family, as a line of the table.
std::string family_text(const StressFamily& family)
{
    const StressFinding* worst = nullptr;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const StressCase& c : family.cases) {
        if (!c.error.empty()) continue;
        const StressFinding& f = c.finding;
        if (!worst || f.deviation * worst->allowed > worst->deviation * f.allowed) worst = &f;
        if (f.sees > 0) {
            least = std::min(least, f.sees);
            most = std::max(most, f.sees);
        }
    }
    if (!worst) return "";
    const std::string sees = most > 0 ? fmt::format("; sees {:.2g} to {:.2g} %", 100 * least, 100 * most) : "";
    return fmt::format("  worst: {:.3g} of {:.3g} {}{}\n", worst->deviation, worst->allowed, worst->unit, sees);
}

} // namespace

std::string stress_text(const StressReport& report)
{
    size_t done = 0, failed = 0;
    uint64_t non_finite = 0;
    std::string text = fmt::format("{:<50} {:>9} {:>9} {:<9} {:>7} {:>7} {:>7}\n", "case", "deviation", "allowed",
                                   "unit", "sees", "dropped", "seconds");
    for (const StressFamily& family : report.families) {
        if (family.cases.empty()) continue;
        text += fmt::format("\n{}: {}\n  allowed: {}\n", family.name, family.compared, family.why);
        for (const StressCase& c : family.cases) {
            const StressFinding& f = c.finding;
            const std::string sees = f.sees > 0 ? fmt::format("{:.2g} %", 100 * f.sees) : "any";
            text += fmt::format("  {:<48} {:>9.3g} {:>9.3g} {:<9} {:>7} {:>7} {:>7.1f} {}\n", c.name, f.deviation,
                                f.allowed, f.unit, sees, f.non_finite, c.seconds, c.passed() ? "pass" : "FAIL");
            if (!c.error.empty()) text += "      " + c.error + "\n";
            if (f.sees > f.must_see) text += fmt::format("      too noisy: must see {:.2g} %\n", 100 * f.must_see);
            if (f.leaks > 0) text += fmt::format("      {} rays lost between triangles\n", f.leaks);
            if (f.length() < f.least_length)
                text += fmt::format("      paths have {:.3g} vertices on average, at least {:.3g} are expected\n",
                                    f.length(), f.least_length);
            if (f.stopped > 0) text += fmt::format("      {} paths did not end in time\n", f.stopped);
            if (!f.remark.empty()) text += "      " + f.remark + "\n";
            ++done;
            failed += !c.passed();
            non_finite += f.non_finite;
        }
        text += family_text(family);
    }
    return text + fmt::format("\n{} of {} cases pass, {} samples not finite, {:.0f} s\n", done - failed, done,
                              non_finite, report.seconds);
}

nlohmann::json stress_json(const StressReport& report)
{
    nlohmann::json families = nlohmann::json::array();
    for (const StressFamily& family : report.families) {
        nlohmann::json cases = nlohmann::json::array();
        for (const StressCase& c : family.cases) {
            const StressFinding& f = c.finding;
            cases.push_back({{"name", c.name},
                             {"passed", c.passed()},
                             {"deviation", f.deviation},
                             {"allowed", f.allowed},
                             {"unit", f.unit},
                             {"least_seen", f.sees},
                             {"must_see", f.must_see},
                             {"remark", f.remark},
                             {"error", c.error},
                             {"seconds", c.seconds},
                             {"paths", f.paths},
                             {"segments", f.segments},
                             {"events", f.events},
                             {"shells", f.shells},
                             {"non_finite", f.non_finite},
                             {"stopped", f.stopped},
                             {"leaks", f.leaks},
                             {"longest_path", f.longest}});
        }
        families.push_back(
            {{"name", family.name}, {"compared", family.compared}, {"why_allowed", family.why}, {"cases", cases}});
    }
    return {{"passed", report.passed()}, {"seconds", report.seconds}, {"families", families}};
}

} // namespace scree
