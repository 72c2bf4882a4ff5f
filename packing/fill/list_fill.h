#pragma once

#include "base/progress.h"
#include "ingest/particles/particle_frame.h"
#include "packing/fill/procedural_fill.h"

#include <functional>

namespace scree {

/// Lists the spheres of a fill in batches of about `batch` spheres, in the order of their ids, with the ids, radii and
/// types they have in the fill. Each frame's `domain` and `origin` are the mesh's bounds and their middle. Throws
/// Cancelled.
void list_fill(const ProceduralFill& fill, uint64_t batch, const std::function<void(const ParticleFrame&)>& take,
               const Progress& progress);

} // namespace scree
