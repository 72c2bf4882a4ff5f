#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"

#include <vector>

namespace scree {

/// A number with its standard error.
struct Measured {
    double value = 0, standard_error = 0;
};

/// Pair correlation g(x), x = d / (r_i + r_j): the density of other spheres around a sphere over that without
/// correlation.
struct PairCorrelation {
    double bin_width = 0.02;
    double x_max = 0; ///< 0: no sphere is deep enough in the bulk for a measurement
    std::vector<double> g; ///< of bins k bin_width .. (k + 1) bin_width
    uint64_t centres = 0; ///< spheres around which it was measured

    /// g(1+): a parabola fitted to ln g over 1 < x < fit_end, with a jackknife error over 64 blocks of space.
    static constexpr double fit_end = 1.2;
    Measured contact;
    uint64_t fitted_pairs = 0;

    /// g(1+) from free paths. On a random line, a sphere of an equilibrium fluid is equally likely to be anywhere
    /// between the two spheres it would hit. So sum_j <delta(d_ij - s_ij)> = <2 / l> (1 / l for each end), where l is
    /// the length of the sphere's path. Exact in equilibrium, and far less noisy than a fit (the virial theorem along
    /// lines). Out of equilibrium it measures how jammed the spheres are.
    Measured free_path_contact;
    /// Both values combined with the weights of least variance, which take their correlation into account.
    Measured best_contact;
    double reduced_pressure = 0; ///< P V / N k T from the same free paths
    uint64_t free_paths = 0;
};

/// Measures g(x). number_density: of the bulk, spheres per volume. Throws Cancelled.
PairCorrelation measure_pair_correlation(const PackedSpheres& spheres, double number_density,
                                         const Progress& progress = {});

} // namespace scree
