#pragma once

#include "render/equivalent/packing_sample.h"
#include "render/equivalent/packing_walk.h"

namespace scree {

struct BedWalk {
    PackingWalk walk;
    double pack_rate = 0; ///< pack rate of the packing that was used
};

/// Walks in a practically endless packing like that of a world: in the tile of its fill, or in a tile of the sample's
/// grains, packed to the same pack rate or as densely as possible.
///
/// The result has the unit of length of `world`. Throws InputError (grains that cannot be packed), Cancelled.
BedWalk walk_like(const World& world, const PackingSample& sample, const Progress& progress);

} // namespace scree
