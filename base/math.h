#pragma once

#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathQuat.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace scree {

using Imath::V2d;
using Imath::V3d;
using Imath::V3f;

#ifdef SCREE_DOUBLE
using Real = double;
#else
using Real = float;
#endif

/// RGB light, or a factor that multiplies light at one point. Single precision, except in a build that checks it
/// against double precision (SCREE_DOUBLE).
using Color = Imath::Color3<Real>;

/// RGB values that accumulate along a path: its light, its weight, and the albedo factor of every scattering event.
/// In double, because for an albedo near 1 single precision keeps little of 1 - albedo (nothing at 1 - 1e-8).
using Weight = Imath::Color3<double>;

inline constexpr double pi = std::numbers::pi;

template <class T>
T max_component(const Imath::Color3<T>& c)
{
    return std::max({c.x, c.y, c.z});
}
inline double luminance(const Color& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; } // Rec. 709
template <class T>
bool is_black(const Imath::Color3<T>& c)
{
    return c.x == 0 && c.y == 0 && c.z == 0;
}

inline Weight exp(const Weight& c) { return {std::exp(c.x), std::exp(c.y), std::exp(c.z)}; }

/// sqrt of a number that rounding may have made slightly negative.
inline double safe_sqrt(double x) { return std::sqrt(std::max(0.0, x)); }

/// Right-handed orthonormal frame around a unit normal (Duff et al. 2017, JCGT 6(1)).
struct Frame {
    V3d s, t, n;

    explicit Frame(const V3d& normal) : n(normal)
    {
        const double sign = std::copysign(1.0, n.z);
        const double a = -1 / (sign + n.z);
        const double b = n.x * n.y * a;
        s = V3d(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
        t = V3d(b, sign + n.y * n.y * a, -n.y);
    }
    V3d to_local(const V3d& v) const { return {v.dot(s), v.dot(t), v.dot(n)}; }
    V3d to_world(const V3d& v) const { return s * v.x + t * v.y + n * v.z; }
};

} // namespace scree
