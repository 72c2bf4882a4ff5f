#pragma once

#include "base/math.h"

namespace scree {

enum class MaterialKind : uint8_t { lambert, dielectric, conductor };

/// What a surface is made of.
struct Material {
    MaterialKind kind = MaterialKind::lambert;
    Color reflectance{0.5f}; ///< lambert
    double ior = 1.5; ///< dielectric: index inside over index outside
    Color absorption{0.0f}; ///< dielectric: sigma_a of the interior, per unit of length
    Color tint{1.0f}; ///< dielectric, conductor: weight of every interface event, reflected or transmitted
    Color eta{0.2f}, k{3.9f}; ///< conductor: complex index against vacuum
    double alpha = 0; ///< GGX width; 0 is smooth. The user's roughness is its square root.

    bool transmits() const { return kind == MaterialKind::dielectric; }
    /// Whether scattered directions have no density, so that lights cannot be sampled.
    bool is_delta() const { return kind != MaterialKind::lambert && alpha == 0; }
};

} // namespace scree
