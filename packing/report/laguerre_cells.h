#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"

#include <vector>

namespace scree {

/// The cells of the spheres in the Laguerre (power) tessellation, and which part of its cell a sphere fills.
///
/// Spheres that touch have their contact plane as common face; between equal spheres it is the Voronoi tessellation.
struct LaguerreCells {
    uint64_t cells = 0;
    uint64_t hidden = 0; ///< spheres without cell: they lie deep inside of others
    uint64_t unbounded = 0; ///< cells that depend on what is not known, left out
    bool whole_box = false; ///< the cells of all spheres of a periodic box: their volumes add up to its volume
    double cell_volume = 0, sphere_volume = 0; ///< sums
    double mean = 0, deviation = 0, least = 0, greatest = 0; ///< of the local fractions
    static constexpr double bin_width = 0.01;
    std::vector<uint64_t> counts = std::vector<uint64_t>(100); ///< spheres by local fraction
};

/// Of a bulk of more than 100,000 spheres a block in its middle. number_density: of the bulk. Throws Cancelled.
LaguerreCells measure_laguerre_cells(const PackedSpheres& spheres, double number_density,
                                     const Progress& progress = {});

} // namespace scree
