#pragma once

#include "base/sampler.h"
#include "render/grains/exemplar.h"
#include "render/materials/material.h"

namespace scree {

/// A grain that light is traced through: its shape and its material.
struct GrainBody {
    const Exemplar* exemplar = nullptr; ///< null: the unit sphere itself
    Material material;
};

/// How a path left the unit bounding sphere of a grain.
struct GrainExit {
    V3d point{0}, direction{0}; ///< x_i on the sphere and omega_i, in the paper's symbols; unit
    double length = 0; ///< of the path inside the grain's material, in radii of the bounding sphere
    uint32_t events = 0; ///< scatterings at the surface; 0: the grain was missed
    Color weight{1};
    bool lost = false; ///< given up: a scattering was invalid, or there were more than 10^6 events (4096 where the
                       ///< material does not transmit)
};

/// The material without the losses that rendering applies: no absorption, white tint and reflectance. The rest of the
/// material decides the directions, and the weights of metals.
Material lossless(const Material& material);

/// Traces one path through a grain, in grain coordinates, from o on the unit sphere inwards along d. The path ends
/// where it leaves the sphere: the sphere is convex, so the path cannot return.
GrainExit walk_grain(const GrainBody& body, V3d o, V3d d, Sampler& sampler);

} // namespace scree
