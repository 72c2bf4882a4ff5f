#pragma once

#include "base/progress.h"
#include "render/stress/stress_report.h"

namespace scree {

struct StressOptions {
    bool quick = false; ///< a part of the cases, in under a minute
    std::string only; ///< only cases with this text in "family: case"; empty: all
};

/// Stress-tests the numerics by rendering: scaled, moved and turned scenes, grains and media with extreme parameters,
/// paths of a million vertices, the white furnace. Seeds are fixed: the same program finds the same.
///
/// The scenes are small and in temporary files. Throws InputError if there is no room for them, and Cancelled.
StressReport run_stress(const StressOptions& options, const Progress& progress);

} // namespace scree
