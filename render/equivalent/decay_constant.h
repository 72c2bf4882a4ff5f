#pragma once

namespace scree {

/// How light dies away deep in a homogeneous medium: as exp(-kappa sigma_t z), with kappa of single-scattering albedo
/// and the asymmetry g of a Henyey-Greenstein phase function.
///
/// kappa in [0, 1) is where the tridiagonal system of the spherical-harmonics equations, a_l = (2 l + 1)(1 - albedo
/// g^l) on the diagonal and l kappa beside it, stops being positive definite; for g = 0 that is albedo atanh(kappa) =
/// kappa (Case and Zweifel 1967, Linear Transport Theory). 0 for albedo 1; 1 for albedo 0. albedo in 0..1, g in (-1,
/// 1).
double decay_constant(double albedo, double g);

/// The inverse: the albedo of which decay_constant is kappa (0..1).
double albedo_of_decay(double kappa, double g);

} // namespace scree
