#pragma once

#include "base/progress.h"
#include "render/stress/stress_report.h"

namespace scree {

struct StressOptions {
    bool quick = false; ///< a part of the cases, in under a minute
    std::string only; ///< cases whose name, or that of their family, holds this; empty: all
};

/// Renders what tests the numbers to their limits: scenes that are scaled, moved and turned, grains and media at the
/// ends of what can be asked for, paths of a million vertices, the white furnace. Seeds are fixed: the same program
/// finds the same.
///
/// Scenes are small ones in temporary files. Throws InputError where there is no room for them, and Cancelled.
StressReport run_stress(const StressOptions& options, const Progress& progress);

} // namespace scree
