#pragma once

#include "base/sampler.h"
#include "render/materials/material.h"

namespace scree {

// Scattering at a surface. Directions are in the local frame of the geometric normal (z outwards) and point away from
// the surface; wo.z < 0 means that the path is inside. Weights apply to basic radiance L / n^2, which an interface
// conserves. No light and no camera is inside a dielectric, so no factor n^2 is ever needed.

struct BsdfSample {
    V3d wi{0};
    Color weight{0}; ///< f |cos| / density
    double pdf = 0; ///< pdf_bsdf(wo, wi); 0 for a delta direction
    bool valid = false;
};

/// Draws wi; invalid if nothing is scattered or a number is not finite.
BsdfSample sample_bsdf(const Material& material, const V3d& wo, Sampler& sampler);

/// f(wo, wi) |wi.z|; for rough dielectrics and conductors an unbiased estimate. 0 for delta materials.
Color eval_bsdf(const Material& material, const V3d& wo, const V3d& wi, Sampler& sampler);

/// The density of sample_bsdf (for rough dielectrics and conductors similar to it, see proxy_pdf_walk); 0 for delta.
double pdf_bsdf(const Material& material, const V3d& wo, const V3d& wi);

} // namespace scree
