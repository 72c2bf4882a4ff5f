#pragma once

#include "render/equivalent/packing_sample.h"
#include "render/equivalent/packing_walk.h"

namespace scree {

struct BedWalk {
    PackingWalk walk;
    double pack_rate = 0; ///< of the packing walked in
};

/// Walks in an endless packing like that of a world: its tile, or one packed of the sample's grains as densely, or as
/// densely as they go.
///
/// The lengths of the result are those of `world`. Throws InputError (grains that do not pack), Cancelled.
BedWalk walk_like(const World& world, const PackingSample& sample, const Progress& progress);

} // namespace scree
