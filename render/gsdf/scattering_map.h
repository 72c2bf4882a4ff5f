#pragma once

#include "base/progress.h"
#include "render/gsdf/grain_walk.h"
#include "render/gsdf/gsdf.h"

#include <array>
#include <vector>

namespace scree {

/// How a grain scatters light, averaged over its rotations: the joint distribution p(omega_i, gamma_o | beta_o) of
/// where and in which direction light leaves the bounding sphere, in cells.
///
/// This is our reading of Figures 5 to 32 of the supplement of Müller et al. 2016. n_o is the normal at the entry x_o,
/// looking inwards; omega_o goes into the sphere, omega_i out of it at x_i. Azimuths about n_o count from the plane of
/// x_o, the centre and x_i: gamma_o is omega_o's and gamma_i is omega_i's. Where x_i is within 0.3 radii of x_o, that
/// plane is not meaningful, and the plane of incidence replaces it. A map keeps the correlation between the place where
/// light leaves and its direction; a product of the two distributions loses the correlation.
///
/// Cells are equally wide in cos beta_o, gamma_o, beta_i (0 along n_o, the first half is front-facing), and
/// delta = gamma_i - gamma_o, the azimuth of omega_i from the plane of incidence. Azimuths 0 and pi are in the middle
/// of their cells, because spheres scatter only there.
struct ScatteringMap {
    static constexpr uint32_t rows = 8, turns = 8, polar = 16, azimuths = 24;
    static constexpr uint32_t directions = polar * azimuths, row_cells = turns * directions;

    std::vector<double> mass =
        std::vector<double>(rows * row_cells); ///< of cells, given that light is scattered: every row sums to 1
    std::array<double, rows> row_mass{}; ///< each row's share of all scattered light from far away

    static size_t index(uint32_t row, uint32_t turn, uint32_t direction)
    {
        return (static_cast<size_t>(row) * turns + turn) * directions + direction;
    }
    /// The bounds of a row in q = sin^2 beta_o.
    static double lowest_q(uint32_t row);
    static double highest_q(uint32_t row);
    /// turn * directions + direction for light that leaves at `point` along w (both in the frame of the Encounter).
    static uint32_t cell_of(double q, const V3d& point, const V3d& w);
    /// Solid angle of a direction's cell, as a share of the sphere.
    static double solid_angle_share(uint32_t direction);

    /// Masses summed over turns: rows * directions values.
    std::vector<double> direction_mass() const;
};

/// Maps from paths traced through the grain, in three independent sets of paths / 3 each.
struct BruteForceMaps {
    std::array<ScatteringMap, 2> halves; ///< to compare with
    ScatteringMap both; ///< the halves together
    ScatteringMap other; ///< to fit simpler forms to
    uint64_t paths = 0;
};

/// Traces the maps with paths independent of build_gsdf's; the same for any number of threads. Throws Cancelled.
BruteForceMaps brute_force_maps(const GrainBody& body, uint64_t paths, uint64_t seed, const Progress& progress = {});

/// The map of what proxy path tracing samples from the GSDF, computed without sampling noise.
ScatteringMap map_of_gsdf(const Gsdf& gsdf);

} // namespace scree
