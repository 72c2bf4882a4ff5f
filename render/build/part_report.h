#pragma once

#include "base/stopwatch.h"

#include <cstdint>
#include <string>

namespace scree {

/// The cost of one part of a world, or why it was skipped. For `--plan` and the statistics.
struct PartReport {
    std::string part; ///< e.g. "exemplar 'sugar'"
    bool built = false;
    std::string reason; ///< what was built, or why it was skipped
    double seconds = 0;
    uint64_t bytes = 0;
};

} // namespace scree
