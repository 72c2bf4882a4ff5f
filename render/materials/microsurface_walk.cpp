#include "render/materials/microsurface_walk.h"

#include "render/materials/fresnel.h"
#include "render/materials/ggx.h"

namespace scree {

namespace {

V3d flip(const V3d& w) { return {w.x, w.y, -w.z}; }

/// Where a walk is on the microsurface. The height enters only as c, the share of the surface that lies below it (C1(h)
/// in the paper); a free flight is c <- c (1-u)^(-1/lambda) for any distribution of heights. Behind the interface the
/// surface is seen upside down: directions are mirrored and c counts from the other side.
struct Walk {
    const Material& material;
    const Ggx ggx;
    const double eta; // -z over +z
    V3d w; // direction of travel, in the frame of the side the walk is on
    double c = 1; // in the frame of that side
    bool below = false; // on the side of -z
    Color weight{1};

    /// Flies to the next facet; false when the walk leaves the microsurface.
    bool fly(double u)
    {
        const double lambda = ggx.lambda(w);
        if (w.z >= 0 && u > 1 - std::pow(c, lambda)) return false;
        c = std::min(1.0, c * std::pow(1 - u, -1 / lambda));
        return true;
    }

    double relative_index() const { return below ? 1 / eta : eta; }

    /// Scatters at a facet seen from -w.
    void scatter(Sampler& sampler)
    {
        const V3d in = -w;
        const double u1 = sampler.next(), u2 = sampler.next();
        const V3d m = ggx.sample_visible(in, u1, u2);
        const double cosine = std::clamp(in.dot(m), 0.0, 1.0);
        if (material.kind == MaterialKind::conductor) {
            weight *= fresnel_conductor(cosine, material.eta, material.k);
            w = reflect(in, m).normalized();
            return;
        }
        double cos_t;
        const double reflectance = fresnel_dielectric(cosine, relative_index(), cos_t);
        if (sampler.next() < reflectance) {
            w = reflect(in, m).normalized();
        } else {
            w = flip(refract(in, m, relative_index(), cos_t).normalized());
            c = 1 - c;
            below = !below;
        }
    }

    /// Density (times weight) of one scattering from -w to out, both in the frame of the walk's side;
    /// `through`: out lies behind the interface.
    Color phase(const V3d& out, bool through) const
    {
        const V3d in = -w;
        if (!through) {
            const V3d sum = in + out;
            const double length = sum.length();
            if (!(length > 0)) return Color(0);
            V3d m = sum / length;
            if (m.z <= 0) return Color(0);
            const double cosine = in.dot(m);
            if (cosine <= 0) return Color(0);
            const double density = ggx.d_visible(in, m) / (4 * cosine);
            if (material.kind == MaterialKind::conductor) {
                return fresnel_conductor(std::min(1.0, cosine), material.eta, material.k) * static_cast<Real>(density);
            }
            double cos_t;
            return Color(
                static_cast<Real>(density * fresnel_dielectric(std::min(1.0, cosine), relative_index(), cos_t)));
        }
        // Walter et al. 2007, eq. 16 and 17: m is along -(in + eta out), here turned to the side of `in`.
        const double n = relative_index();
        V3d m = in + n * out;
        const double length = m.length();
        if (!(length > 0)) return Color(0);
        m *= (m.z < 0 ? -1 : 1) / length;
        const double cos_in = in.dot(m), cos_out = -out.dot(m);
        if (cos_in <= 0 || cos_out <= 0) return Color(0);
        double cos_t;
        const double transmittance = 1 - fresnel_dielectric(std::min(1.0, cos_in), n, cos_t);
        const double denominator = cos_in - n * cos_out;
        const double density = ggx.d_visible(in, m) * transmittance * n * n * cos_out / (denominator * denominator);
        return Color(static_cast<Real>(density));
    }
};

bool finite(const V3d& v) { return std::isfinite(v.x + v.y + v.z); }

} // namespace

WalkSample sample_walk(const Material& material, double eta, const V3d& wo, Sampler& sampler)
{
    Walk walk{material, {material.alpha}, eta, -wo};
    while (walk.fly(sampler.next())) {
        walk.scatter(sampler);
        if (!finite(walk.w)) return {V3d(0), Color(0), false};
    }
    return {walk.below ? flip(walk.w) : walk.w, walk.weight, true};
}

Color estimate_walk(const Material& material, double eta, const V3d& wo, const V3d& wi, Sampler& sampler)
{
    const bool to_below = wi.z < 0;
    Walk walk{material, {material.alpha}, eta, -wo};
    Color sum(0);
    while (walk.fly(sampler.next())) {
        const V3d out = walk.below ? flip(wi) : wi; // in the frame of the walk's side
        const V3d out_own = to_below ? flip(wi) : wi; // in the frame of its own side: points up
        const bool through = walk.below != to_below;
        const double c_out = through ? 1 - walk.c : walk.c;
        const double escape = std::pow(c_out, walk.ggx.lambda(out_own));
        const Color term = walk.weight * walk.phase(out, through) * static_cast<Real>(escape);
        if (std::isfinite(term.x + term.y + term.z)) sum += term;
        walk.scatter(sampler);
        if (!finite(walk.w)) break;
    }
    return sum;
}

double proxy_pdf_walk(const Material& material, double eta, const V3d& wo, const V3d& wi)
{
    const Walk walk{material, {material.alpha}, eta, -wo};
    const Color single = walk.phase(wi, wi.z < 0);
    const double lobe = 0.2 * std::abs(wi.z) / pi; // roughly the walks of more than one bounce
    return 0.8 * luminance(single) + lobe;
}

} // namespace scree
