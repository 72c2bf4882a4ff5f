#pragma once

#include "render/medium/packing_sample.h"
#include "render/medium/packing_walk.h"

namespace scree {

/// Walks in an endless packing like that of a world: its tile, or one packed of the sample's grains as densely.
///
/// The lengths of the result are those of `world`. Throws InputError when grains cannot be packed so densely at random, Cancelled.
PackingWalk walk_like(const World& world, const PackingSample& sample, const Progress& progress);

} // namespace scree
