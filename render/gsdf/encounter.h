#pragma once

#include "base/math.h"

namespace scree {

/// The frame in which a grain's scattering is recorded: z is the direction omega_o of the incoming ray, which enters
/// the unit bounding sphere at x_o = (b, 0, -cos beta_o), b = sin beta_o >= 0.
///
/// beta_o is the angle between omega_o and the inward normal n_o at x_o (Müller et al. 2016, supplement, Algorithm 1).
struct Encounter {
    V3d x, y, z;
    double q = 0; ///< b^2 = sin^2 beta_o, 0..1; uniformly distributed for light from far away

    /// entry: x_o, unit, from the sphere's centre. direction: omega_o, unit.
    Encounter(const V3d& entry, const V3d& direction) : z(direction)
    {
        const V3d across = entry - entry.dot(direction) * direction;
        const double b2 = across.length2();
        q = std::min(b2, 1.0);
        x = b2 > 0 ? across / std::sqrt(b2) : Frame(direction).s;
        y = z.cross(x);
    }
    double cos_beta() const { return std::sqrt(1 - q); }
    V3d to_world(const V3d& v) const { return v.x * x + v.y * y + v.z * z; }
    V3d to_local(const V3d& v) const { return {v.dot(x), v.dot(y), v.dot(z)}; }
};

} // namespace scree
