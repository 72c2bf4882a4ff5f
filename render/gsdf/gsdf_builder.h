#pragma once

#include "base/progress.h"
#include "render/gsdf/grain_walk.h"
#include "render/gsdf/gsdf.h"

#include <memory>

namespace scree {

struct GsdfOptions {
    double error = 0.01; ///< wanted relative error of the directional density (GsdfQuality::density_error)
    uint64_t most_paths = 1 << 27; ///< stops here even if the error is larger; GsdfQuality has the error reached
    uint64_t seed = 0;

    bool operator==(const GsdfOptions&) const = default;
};

/// Traces paths through a grain, from all directions and at all beta_o, until the directional density is known to the
/// wanted error.
///
/// Scattering is reciprocal, so each path also counts in reverse. The result is the same for any number of threads.
/// Throws Cancelled when `progress` is cancelled.
std::shared_ptr<const Gsdf> build_gsdf(const GrainBody& body, const GsdfOptions& options,
                                       const Progress& progress = {});

} // namespace scree
