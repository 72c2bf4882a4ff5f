#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"

#include <vector>

namespace scree {

/// A number with its standard error.
struct Measured {
    double value = 0, standard_error = 0;
};

/// How densely other spheres lie around a sphere: g(x), x = d / (r_i + r_j), against places without correlation.
struct PairCorrelation {
    double bin_width = 0.02;
    double x_max = 0; ///< 0: no sphere is deep enough in the bulk to measure around
    std::vector<double> g; ///< of bins k bin_width .. (k + 1) bin_width
    uint64_t centres = 0; ///< spheres around which it was measured

    /// g(1+): ln g fitted over 1 < x < fit_end by a parabola, with the error by jackknife over 64 blocks of space.
    static constexpr double fit_end = 1.2;
    Measured contact;
    uint64_t fitted_pairs = 0;

    /// g(1+) from free paths: along a random line a sphere of an equilibrium fluid is anywhere between the two it would
    /// hit, so that sum_j <delta(d_ij - s_ij)> = <(2 / l) (one for either end)>, l the length of its way. Exact in
    /// equilibrium, and far less noisy than a fit (the virial theorem along lines); elsewhere a measure of how jammed
    /// the spheres are.
    Measured free_path_contact;
    /// Both together with the weights of least variance, their correlation allowed for.
    Measured best_contact;
    double reduced_pressure = 0; ///< P V / N k T by the same paths
    uint64_t free_paths = 0;
};

/// number_density: of the bulk, spheres per volume. Throws Cancelled.
PairCorrelation measure_pair_correlation(const PackedSpheres& spheres, double number_density,
                                         const Progress& progress = {});

} // namespace scree
