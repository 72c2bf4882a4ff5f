#pragma once

#include "base/sampler.h"
#include "render/materials/material.h"

namespace scree {

/// Rough interfaces that lose no energy: a random walk over the GGX microsurface until it is left
/// (Heitz, Hanika, d'Eon, Dachsbacher 2016). Conductors and dielectrics, wo above the surface (wo.z > 0).
///
/// Weights are those of basic radiance L / n^2, which an interface conserves.
struct WalkSample {
    V3d wi; ///< z < 0: transmitted
    Color weight{1}; ///< 1 for a dielectric, the product of Fresnel reflectances for a conductor
    bool valid = true;
};

/// eta: index of the side of -z over that of +z (dielectrics).
WalkSample sample_walk(const Material& material, double eta, const V3d& wo, Sampler& sampler);

/// One unbiased estimate of f(wo, wi) |wi.z|.
Color estimate_walk(const Material& material, double eta, const V3d& wo, const V3d& wi, Sampler& sampler);

/// A density over wi like that of sample_walk, but not equal to it: single scattering plus a share of cosine lobes.
/// Good for weighing strategies, which needs only that all of them use the same function.
double proxy_pdf_walk(const Material& material, double eta, const V3d& wo, const V3d& wi);

} // namespace scree
