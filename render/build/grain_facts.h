#pragma once

#include "ingest/particles/particle_frame.h"
#include "render/grains/grain_fill.h"
#include "render/scene/transport_plan.h"

#include <vector>

namespace scree {

/// Facts of listed spheres, without those of radius 0. types: each sphere's index into `descriptions`.
GrainFacts facts_of_list(const ParticleFrame& frame, const std::vector<uint8_t>& types,
                         const std::vector<GrainTypeDescription>& descriptions);

/// Facts of a fill; the shares of its grain types are estimated from a sample of its spheres.
GrainFacts facts_of_fill(const GrainFill& fill, const std::vector<GrainTypeDescription>& descriptions);

} // namespace scree
