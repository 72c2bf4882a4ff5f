#pragma once

#include "render/gsdf/scattering_map.h"

#include <string>
#include <vector>

namespace scree {

/// How far a form of scattering is from the truth: means over what is scattered of light from afar of the integrals of
/// |p - p_true|, 0 to 2.
struct FormError {
    std::string form;
    double direction = 0; ///< of p(omega_i | beta_o)
    double full = 0; ///< of p(omega_i, gamma_o | beta_o), see ScatteringMap
};

/// The error of the GSDF beside those of the best of simpler forms.
struct MapErrors {
    /// gsdf; then factored: what leaves where, times what leaves where to, both tabulated; hg: Henyey and Greenstein's
    /// form (1941) about omega_o with the g of least error for each beta_o, leaving where as measured; isotropic: every
    /// direction alike, from anywhere on the sphere.
    std::vector<FormError> forms;
    FormError noise; ///< what the truth itself would show, as it is known from finitely many paths
    std::array<double, ScatteringMap::rows> hg_g{}; ///< that was fitted
};

/// Compares with the two halves of `truth` together; simpler forms are fitted to its other set.
MapErrors map_errors(const ScatteringMap& gsdf, const BruteForceMaps& truth);

/// The error of one map against another.
FormError compare_maps(const std::string& form, const ScatteringMap& map, const ScatteringMap& truth);

} // namespace scree
