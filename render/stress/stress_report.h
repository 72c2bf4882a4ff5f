#pragma once

#include "render/loop/render_loop.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace scree {

/// What was found in one case of the stress test.
struct StressFinding {
    double deviation = 0; ///< the worst
    double allowed = 0;
    std::string unit; ///< of both: "sigma", "of 1", "pixels" ...
    double sees = 0; ///< least relative deviation of the picture's mean that the case finds nine times in ten; 0: any
    double must_see = 0.03; ///< a case is too noisy to pass if its `sees` is larger
    std::string remark; ///< where, and what else is worth knowing
    uint64_t paths = 0, segments = 0, events = 0, shells = 0, non_finite = 0;
    uint64_t leaks = 0; ///< rays lost between two triangles
    double may_leak = 0; ///< part of all paths that may be lost this way
    uint64_t stopped = 0; ///< paths given up as time ran out
    double least_length = 0; ///< mean length that paths must have, so that a case really tests long paths
    uint64_t longest = 0; ///< vertices of the longest path: segments, and events in media where they count

    /// Adds the counts of a render.
    void count(const RenderStatistics& statistics);
    /// Mean number of segments, medium events and shells of a path.
    double length() const;
    bool passed() const;
};

struct StressCase {
    std::string name;
    StressFinding finding;
    double seconds = 0;
    std::string error; ///< why the case could not run; else empty

    bool passed() const { return error.empty() && finding.passed(); }
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

/// A table for people: a line for each case, and below it what went wrong.
std::string stress_text(const StressReport& report);
nlohmann::json stress_json(const StressReport& report);

} // namespace scree
