#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// A number that was measured, with its standard error.
struct Measured {
    double value = 0, error = 0;
};

/// A way of some scatterings through a packing, seen from all sides alike.
struct DecayWay {
    float length; ///< of the straight line from its start to its end
    float start, end; ///< cosines of that line with the directions at the start and the end
    float turn; ///< cosine between these directions
    float kept; ///< weight
};

/// How deep light decays, as exp(-kappa z), by ways that all are of m scatterings, in independent batches.
///
/// Deep light of a direction-dependence phi(mu) keeps its shape: over m scatterings <weight exp(kappa z) phi(mu_m)> =
/// phi(mu_0). With phi spanned by Legendre polynomials up to order 2 this is (Galerkin) an eigenvalue problem of 3 x 3
/// means over ways, <P_k(mu_0) weight exp(kappa z) P_l(mu_m)>, each averaged over all rotations in closed form; kappa
/// is where its largest eigenvalue is 1. The more scatterings a way has, the less does what phi lacks count, and the
/// rarer are the ways that decide. Value 0 where nothing is lost or nothing is known.
///
/// Where kappa is above half the rate at which long flights become rare, the mean over ways has no variance: the result
/// is then a little high and its error too low (exponential flights, g -0.4, albedo 0.8, kappa 0.8: 1.3 % from 1.6
/// million scatterings). Three polynomials are few for light that is both thrown forwards and absorbed (g 0.85, albedo
/// 0.8, 8 scatterings: 0.6 % high).
Measured decay_of_ways(std::span<const std::vector<DecayWay>> batches);

} // namespace scree
