#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// A measured number with its standard error.
struct Measured {
    double value = 0, error = 0;
};

/// A path of some scatterings through a packing, described independently of its orientation.
struct DecayWay {
    float length; ///< length of the straight line from its start to its end
    float start, end; ///< cosines between that line and the directions at start and end
    float turn; ///< cosine between these two directions
    float kept; ///< weight: the part of the light that is kept
};

/// The rate kappa at which light deep in a packing decays, as exp(-kappa z), from paths that all have m scatterings, in
/// independent batches.
///
/// Deep light has a stationary angular distribution phi(mu): over m scatterings <weight exp(kappa z) phi(mu_m)> =
/// phi(mu_0). With phi spanned by Legendre polynomials up to order 2, Galerkin's method gives an eigenvalue problem of
/// 3 x 3 means over paths, <P_k(mu_0) weight exp(kappa z) P_l(mu_m)>, each averaged over all rotations in closed form;
/// kappa is the value for which its largest eigenvalue is 1. With more scatterings per path, the missing higher orders
/// of phi matter less, but the result depends on rarer paths. The value is 0 if nothing is lost or nothing is known.
///
/// If kappa exceeds half the rate at which long flights become rare, the mean over paths has no finite variance: the
/// result is then slightly high and its error estimate too low (exponential flights, g -0.4, albedo 0.8, kappa 0.8: 1.3
/// % from 1.6 million scatterings). Three polynomials are few for light that is both scattered forwards and absorbed (g
/// 0.85, albedo 0.8, 8 scatterings: 0.6 % high).
Measured decay_of_ways(std::span<const std::vector<DecayWay>> batches);

} // namespace scree
