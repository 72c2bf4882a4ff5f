#pragma once

#include "ingest/particles/particle_frame.h"
#include "render/grains/grain_fill.h"
#include "render/scene/transport_plan.h"

#include <vector>

namespace scree {

/// Facts of spheres of a list, those of radius 0 left out; types: of each, a number into `descriptions`.
GrainFacts facts_of_list(const ParticleFrame& frame, const std::vector<uint8_t>& types,
                         const std::vector<GrainTypeDescription>& descriptions);

/// Facts of a fill; which types there are, and how much of each, is as a sample of its spheres has it.
GrainFacts facts_of_fill(const GrainFill& fill, const std::vector<GrainTypeDescription>& descriptions);

} // namespace scree
