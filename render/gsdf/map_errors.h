#pragma once

#include "render/gsdf/scattering_map.h"

#include <string>
#include <vector>

namespace scree {

/// The error of a form of scattering: the integral of |p - p_true|, 0 to 2, averaged over the scattered light from far
/// away.
struct FormError {
    std::string form;
    double direction = 0; ///< of p(omega_i | beta_o)
    double full = 0; ///< of p(omega_i, gamma_o | beta_o), see ScatteringMap
};

/// The error of the GSDF, and for comparison the errors of the best simpler forms.
struct MapErrors {
    /// gsdf; factored: the tabulated distribution of the place times that of the direction; hg: the tabulated
    /// distribution of the place times Henyey and Greenstein's form (1941) about omega_o, with the g of least error for
    /// each beta_o; isotropic: all directions and all places on the sphere alike.
    std::vector<FormError> forms;
    FormError noise; ///< error of the truth itself, because it comes from finitely many paths
    std::array<double, ScatteringMap::rows> hg_g{}; ///< the fitted g of each row
};

/// Compares all forms with truth.both; the simpler forms are fitted to truth.other.
MapErrors map_errors(const ScatteringMap& gsdf, const BruteForceMaps& truth);

/// The error of one map against another.
FormError compare_maps(const std::string& form, const ScatteringMap& map, const ScatteringMap& truth);

} // namespace scree
