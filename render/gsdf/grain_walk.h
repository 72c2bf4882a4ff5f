#pragma once

#include "base/sampler.h"
#include "render/grains/exemplar.h"
#include "render/materials/material.h"

namespace scree {

/// What light does in one grain: its shape (without an exemplar the unit sphere itself) and its material.
struct GrainBody {
    const Exemplar* exemplar = nullptr;
    Material material;
};

/// How a path left the unit bounding sphere of a grain.
struct GrainExit {
    V3d point{0}, direction{0}; ///< where on the sphere, and where to; unit
    double length = 0; ///< of the way inside the grain's material, in radii of the bounding sphere
    uint32_t events = 0; ///< scatterings at the surface; 0: the grain was missed
    Color weight{1};
    bool lost = false; ///< given up: nothing was scattered, or it took more than 10^6 events (4096 where nothing is
                       ///< transmitted)
};

/// The material without what is applied when rendering: no absorption, white tint and reflectance. What remains decides
/// the directions, and the weights of metals.
Material lossless(const Material& material);

/// Traces one path through a grain from o on the unit sphere along d into it; grain coordinates. Ends where the path
/// leaves the sphere, which as a convex body it does for good.
GrainExit walk_grain(const GrainBody& body, V3d o, V3d d, Sampler& sampler);

} // namespace scree
