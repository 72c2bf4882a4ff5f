#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace scree {

/// What one part of a world cost, or why it is not there. For `--plan` and the statistics.
struct PartReport {
    std::string part;     ///< e.g. "exemplar 'sugar'"
    bool built = false;
    std::string reason;   ///< what was built, or why it was skipped
    double seconds = 0;
    uint64_t bytes = 0;
};

/// Measures from its making.
class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace scree
