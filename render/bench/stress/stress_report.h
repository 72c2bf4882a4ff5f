#pragma once

#include "render/render_loop.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace scree {

/// What was found in one case of the stress test.
struct StressFinding {
    double deviation = 0; ///< the worst
    double allowed = 0;
    std::string unit;     ///< of both: "sigma", "of 1", "pixels" ...
    double sees = 0;      ///< least relative deviation of the picture's mean that the case finds nine times in ten; 0: any
    std::string remark;   ///< where, and what else is worth knowing
    uint64_t paths = 0, segments = 0, non_finite = 0, leaks = 0;
    uint64_t stopped = 0; ///< paths given up as time ran out
    uint64_t longest = 0; ///< vertices of the longest path: segments, and events in media where they count

    /// Takes over what a render counted.
    void count(const RenderStatistics& statistics);
};

struct StressCase {
    std::string name;
    StressFinding finding;
    double seconds = 0;
    std::string error; ///< why it could not be done; else empty

    bool passed() const { return error.empty() && finding.deviation <= finding.allowed && finding.non_finite == 0 && finding.stopped == 0; }
};

/// Cases of one kind.
struct StressFamily {
    std::string name, compared, why; ///< what is compared with what, and why so much is allowed
    std::vector<StressCase> cases;
};

struct StressReport {
    std::vector<StressFamily> families;
    double seconds = 0;

    bool passed() const;
};

/// A table for people: a line a case, and below it what went wrong.
std::string stress_text(const StressReport& report);
nlohmann::json stress_json(const StressReport& report);

} // namespace scree
