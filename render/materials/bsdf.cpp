#include "render/materials/bsdf.h"

#include "base/warp.h"
#include "render/materials/fresnel.h"
#include "render/materials/microsurface_walk.h"

namespace scree {

namespace {

V3d flip_if(const V3d& w, bool flip) { return {w.x, w.y, flip ? -w.z : w.z}; }

/// Index behind the interface over the index on wo's side.
double relative_index(const Material& material, const V3d& wo) { return wo.z > 0 ? material.ior : 1 / material.ior; }

BsdfSample sample_lambert(const Material& material, const V3d& wo, Sampler& sampler)
{
    const double u1 = sampler.next(), u2 = sampler.next();
    const V3d up = sample_cosine_hemisphere(u1, u2);
    return {flip_if(up, wo.z < 0), material.reflectance, pdf_cosine_hemisphere(up), up.z > 0};
}

BsdfSample sample_smooth(const Material& material, const V3d& wo, Sampler& sampler)
{
    const double cos_o = std::abs(wo.z);
    const V3d mirrored(-wo.x, -wo.y, wo.z);
    if (material.kind == MaterialKind::conductor) {
        return {mirrored, material.tint * fresnel_conductor(cos_o, material.eta, material.k), 0, wo.z != 0};
    }
    double cos_t;
    const double eta = relative_index(material, wo);
    const double reflectance = fresnel_dielectric(cos_o, eta, cos_t);
    if (sampler.next() < reflectance) return {mirrored, material.tint, 0, wo.z != 0};
    return {V3d(-wo.x / eta, -wo.y / eta, std::copysign(cos_t, -wo.z)), material.tint, 0, cos_t > 0};
}

} // namespace

BsdfSample sample_bsdf(const Material& material, const V3d& wo, Sampler& sampler)
{
    if (material.kind == MaterialKind::lambert) return sample_lambert(material, wo, sampler);
    if (material.alpha == 0) return sample_smooth(material, wo, sampler);

    const bool below = wo.z < 0;
    const V3d up = flip_if(wo, below);
    const double eta = relative_index(material, wo);
    const WalkSample walk = sample_walk(material, eta, up, sampler);
    if (!walk.valid || walk.wi.z == 0 || up.z == 0) return {};
    return {flip_if(walk.wi, below), material.tint * walk.weight, proxy_pdf_walk(material, eta, up, walk.wi), true};
}

Color eval_bsdf(const Material& material, const V3d& wo, const V3d& wi, Sampler& sampler)
{
    const bool same_side = wo.z * wi.z > 0;
    if (material.kind == MaterialKind::lambert) {
        return same_side ? material.reflectance * static_cast<Real>(std::abs(wi.z) / pi) : Color(0);
    }
    if (material.alpha == 0 || wi.z == 0 || wo.z == 0 || (!same_side && !material.transmits())) return Color(0);
    const bool below = wo.z < 0;
    return material.tint *
           estimate_walk(material, relative_index(material, wo), flip_if(wo, below), flip_if(wi, below), sampler);
}

double pdf_bsdf(const Material& material, const V3d& wo, const V3d& wi)
{
    const bool same_side = wo.z * wi.z > 0;
    if (material.kind == MaterialKind::lambert) return same_side ? std::abs(wi.z) / pi : 0;
    if (material.alpha == 0 || (!same_side && !material.transmits())) return 0;
    const bool below = wo.z < 0;
    return proxy_pdf_walk(material, relative_index(material, wo), flip_if(wo, below), flip_if(wi, below));
}

} // namespace scree
