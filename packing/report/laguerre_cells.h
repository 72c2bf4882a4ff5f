#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"

#include <vector>

namespace scree {

/// The spheres' cells in the Laguerre (power) tessellation, and the part of its cell that each sphere fills.
///
/// The contact plane of two touching spheres is the face between their cells. For equal spheres the tessellation is
/// Voronoi's.
struct LaguerreCells {
    uint64_t cells = 0;
    uint64_t hidden = 0; ///< spheres without a cell: they lie deep inside others
    uint64_t unbounded = 0; ///< cells left out because unknown spheres could bound them
    bool whole_box = false; ///< all spheres of a periodic box have cells: the cells' volumes add up to the box's
    double cell_volume = 0, sphere_volume = 0; ///< sums
    double mean = 0, deviation = 0, least = 0, greatest = 0; ///< of the local fractions
    static constexpr double bin_width = 0.01;
    std::vector<uint64_t> counts = std::vector<uint64_t>(100); ///< spheres by local fraction
};

/// Measures the cells; of more than 100,000 bulk spheres, only a block in the middle. number_density: of the bulk.
/// Throws Cancelled.
LaguerreCells measure_laguerre_cells(const PackedSpheres& spheres, double number_density,
                                     const Progress& progress = {});

} // namespace scree
