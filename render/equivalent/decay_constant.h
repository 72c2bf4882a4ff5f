#pragma once

namespace scree {

/// The decay constant kappa: deep in a homogeneous medium light decays as exp(-kappa sigma_t z). kappa depends on the
/// single-scattering albedo and on the asymmetry g of the Henyey-Greenstein phase function.
///
/// kappa in [0, 1) is the value at which the tridiagonal system of the spherical-harmonics equations, with a_l = (2 l +
/// 1)(1 - albedo g^l) on the diagonal and l kappa beside it, stops being positive definite; for g = 0 this means albedo
/// atanh(kappa) = kappa (Case and Zweifel 1967, Linear Transport Theory). 0 for albedo 1; 1 for albedo 0. albedo in
/// 0..1, g in (-1, 1).
double decay_constant(double albedo, double g);

/// The inverse function: the albedo for which decay_constant() is kappa (0..1).
double albedo_of_decay(double kappa, double g);

} // namespace scree
