#pragma once

#include <string>

namespace scree {

/// Where and when something was measured.
struct Machine {
    std::string processor; ///< model
    int cores = 0; ///< that this program may use
    int threads = 0; ///< that it did use
    std::string date; ///< 2026-11-22, UTC
    std::string build; ///< build_identity()
};

/// threads: 0 means all cores.
Machine this_machine(int threads);

/// Identifies the build: a hash of the running program's file, or the version if that file cannot be read.
const std::string& build_identity();

} // namespace scree
