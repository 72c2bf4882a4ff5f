#pragma once

#include "base/math.h"

namespace scree {

/// Unpolarised Fresnel reflectance of a dielectric interface; cos_i >= 0 on the incident side, eta = n_t / n_i.
/// cos_t returns the cosine on the other side, 0 under total internal reflection.
inline double fresnel_dielectric(double cos_i, double eta, double& cos_t)
{
    if (eta == 1) { // no interface: the differences below would not be exactly 0
        cos_t = cos_i;
        return 0;
    }
    const double sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) {
        cos_t = 0;
        return 1;
    }
    cos_t = std::sqrt(1 - sin2_t);
    const double parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const double perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

/// Unpolarised Fresnel reflectance of a conductor of complex index eta + i k against vacuum
/// (Born and Wolf, Principles of Optics, 7th ed., section 14.2).
inline double fresnel_conductor(double cos_i, double eta, double k)
{
    const double cos2 = cos_i * cos_i, sin2 = 1 - cos2, sin4 = sin2 * sin2;
    const double difference = eta * eta - k * k - sin2;
    const double a2b2 = safe_sqrt(difference * difference + 4 * eta * eta * k * k);
    const double a = safe_sqrt(0.5 * (a2b2 + difference));
    const double perpendicular = (a2b2 + cos2 - 2 * cos_i * a) / (a2b2 + cos2 + 2 * cos_i * a);
    const double denominator = cos2 * a2b2 + sin4 + 2 * cos_i * a * sin2;
    if (denominator == 0) return perpendicular; // eta = k = 0 head on
    const double parallel = perpendicular * (cos2 * a2b2 + sin4 - 2 * cos_i * a * sin2) / denominator;
    return 0.5 * (perpendicular + parallel);
}

inline Color fresnel_conductor(double cos_i, const Color& eta, const Color& k)
{
    return {static_cast<Real>(fresnel_conductor(cos_i, eta.x, k.x)),
            static_cast<Real>(fresnel_conductor(cos_i, eta.y, k.y)),
            static_cast<Real>(fresnel_conductor(cos_i, eta.z, k.z))};
}

inline V3d reflect(const V3d& w, const V3d& m) { return 2 * w.dot(m) * m - w; }

/// Direction of w (pointing away from the interface) refracted through m (w.m > 0); eta = n_t / n_i, cos_t from
/// Fresnel.
inline V3d refract(const V3d& w, const V3d& m, double eta, double cos_t)
{
    return (w.dot(m) / eta - cos_t) * m - w / eta;
}

} // namespace scree
