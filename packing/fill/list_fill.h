#pragma once

#include "base/progress.h"
#include "ingest/particles/particle_frame.h"
#include "packing/fill/procedural_fill.h"

#include <functional>

namespace scree {

/// Lists the spheres of a fill, batch by batch in the order of their ids, with the ids, radii and types they have in
/// the fill; `domain` and `origin` are those of the mesh. A batch has about `batch` spheres. Throws Cancelled.
void list_fill(const ProceduralFill& fill, uint64_t batch, const std::function<void(const ParticleFrame&)>& take,
               const Progress& progress);

} // namespace scree
