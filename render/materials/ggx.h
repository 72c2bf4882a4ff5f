#pragma once

#include "base/math.h"

namespace scree {

/// The isotropic GGX microsurface with Smith masking, seen in its local frame (z up), for directions of any elevation.
///
/// Heitz 2014 (JCGT 3(2)); below the horizon as in Heitz, Hanika, d'Eon, Dachsbacher 2016 ("Multiple-scattering
/// microfacet BSDFs with the Smith model"), eq. 4-9.
struct Ggx {
    double alpha;

    /// Density of slopes over the projected area: integral of D(m) m.z over the hemisphere is 1.
    double d(const V3d& m) const
    {
        if (m.z <= 0) return 0;
        const double a2 = alpha * alpha, c = (m.x * m.x + m.y * m.y) / a2 + m.z * m.z;
        return 1 / (pi * a2 * c * c);
    }

    /// Smith's Lambda; for w below the horizon it is -1 - lambda(-w).
    double lambda(const V3d& w) const
    {
        const double tan2 = (w.x * w.x + w.y * w.y) / (w.z * w.z);
        const double root = std::sqrt(1 + alpha * alpha * tan2);
        return w.z >= 0 ? 0.5 * (root - 1) : -0.5 * (root + 1);
    }

    /// Area of the microsurface projected towards w: w.z (1 + lambda(w)), without its cancellation at grazing angles.
    double projected_area(const V3d& w) const
    {
        return 0.5 * (w.z + std::sqrt(w.z * w.z + alpha * alpha * (w.x * w.x + w.y * w.y)));
    }

    /// A normal drawn among those visible from w, with density d_visible (Heitz 2018, JCGT 7(4); also valid below the
    /// horizon).
    V3d sample_visible(const V3d& w, double u1, double u2) const
    {
        const V3d v = V3d(alpha * w.x, alpha * w.y, w.z).normalized();
        const double h2 = v.x * v.x + v.y * v.y;
        const V3d t1 = h2 > 0 ? V3d(-v.y, v.x, 0) / std::sqrt(h2) : V3d(1, 0, 0);
        const V3d t2 = v.cross(t1);
        const double r = std::sqrt(u1), phi = 2 * pi * u2;
        const double p1 = r * std::cos(phi), s = 0.5 * (1 + v.z);
        const double p2 = (1 - s) * safe_sqrt(1 - p1 * p1) + s * r * std::sin(phi);
        const V3d m = p1 * t1 + p2 * t2 + safe_sqrt(1 - p1 * p1 - p2 * p2) * v;
        return V3d(alpha * m.x, alpha * m.y, std::max(0.0, m.z)).normalized();
    }
    double d_visible(const V3d& w, const V3d& m) const
    {
        const double area = projected_area(w);
        return area > 0 ? std::max(0.0, w.dot(m)) * d(m) / area : 0;
    }
};

} // namespace scree
