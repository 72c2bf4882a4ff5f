#pragma once

#include "base/math.h"

namespace scree {

// Samplers of directions and points, each followed by its density. Directions are unit vectors with z along the axis.

inline V2d sample_disk(double u1, double u2)
{
    const double r = std::sqrt(u1), phi = 2 * pi * u2;
    return {r * std::cos(phi), r * std::sin(phi)};
}

inline V3d sample_cosine_hemisphere(double u1, double u2)
{
    const V2d p = sample_disk(u1, u2);
    return {p.x, p.y, std::sqrt(1 - u1)};
}
inline double pdf_cosine_hemisphere(const V3d& w) { return std::max(0.0, w.z) / pi; }

inline V3d sample_sphere(double u1, double u2)
{
    const double z = 1 - 2 * u1, r = safe_sqrt(1 - z * z), phi = 2 * pi * u2;
    return {r * std::cos(phi), r * std::sin(phi), z};
}
inline double pdf_sphere() { return 1 / (4 * pi); }

/// Uniform over the cone of half-angle theta about z; one_minus_cos = 1 - cos theta, exact for small cones.
inline V3d sample_cone(double u1, double u2, double one_minus_cos)
{
    const double h = u1 * one_minus_cos, r = safe_sqrt(h * (2 - h)), phi = 2 * pi * u2;
    return {r * std::cos(phi), r * std::sin(phi), 1 - h};
}
inline double pdf_cone(double one_minus_cos) { return 1 / (2 * pi * one_minus_cos); }

} // namespace scree
