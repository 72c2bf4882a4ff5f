#pragma once

#include "base/progress.h"
#include "render/gsdf/grain_walk.h"
#include "render/gsdf/gsdf.h"

#include <memory>

namespace scree {

struct GsdfOptions {
    double error = 0.01; ///< wanted of the directional density, relative (GsdfQuality::density_error)
    uint64_t most_paths = 1 << 27; ///< where it is given up for lost; the error reached is said
    uint64_t seed = 0;

    bool operator==(const GsdfOptions&) const = default;
};

/// Traces paths through a grain, from everywhere and at every impact, until the directional density is known to the
/// wanted error.
///
/// As scattering is reciprocal, each path counts as well for the way back. The same result for any number of threads.
/// Throws Cancelled when `progress` was.
std::shared_ptr<const Gsdf> build_gsdf(const GrainBody& body, const GsdfOptions& options,
                                       const Progress& progress = {});

} // namespace scree
