#pragma once

#include "base/sampler.h"
#include "render/materials/material.h"

namespace scree {

/// Result of a random walk over the GGX microsurface until the walk leaves it, so that rough interfaces lose no energy
/// (Heitz, Hanika, d'Eon, Dachsbacher 2016).
///
/// For conductors and dielectrics, with wo above the surface (wo.z > 0). Weights apply to basic radiance L / n^2, which
/// an interface conserves.
struct WalkSample {
    V3d wi; ///< z < 0: transmitted
    Color weight{1}; ///< 1 for a dielectric, the product of Fresnel reflectances for a conductor
    bool valid = true;
};

/// eta: index of the side of -z over that of +z (dielectrics).
WalkSample sample_walk(const Material& material, double eta, const V3d& wo, Sampler& sampler);

/// One unbiased estimate of f(wo, wi) |wi.z|.
Color estimate_walk(const Material& material, double eta, const V3d& wo, const V3d& wi, Sampler& sampler);

/// A density over wi similar to the density of sample_walk, but not equal: single scattering plus a share of a cosine
/// lobe. It serves to weigh sampling strategies, which only need to use the same function.
double proxy_pdf_walk(const Material& material, double eta, const V3d& wo, const V3d& wi);

} // namespace scree
