#pragma once

#include "base/progress.h"
#include "packing/report/near_pairs.h"
#include "packing/report/packed_spheres.h"

#include <vector>

namespace scree {

/// Bond order after Steinhardt, Nelson, Ronchetti (Phys. Rev. B 28, 1983): tells whether a packing has crystallised.
///
/// Neighbours are spheres nearer than 1.4 mean spacings (number density^(-1/3)), scaled by (r_i + r_j) over its cubic
/// mean: 12 in fcc and hcp lattices, 14 in bcc, 6 in simple cubic. A bond is solid-like if the q6 of its two ends agree
/// to more than 0.7 (normalised product; ten Wolde, Ruiz-Montero, Frenkel, J. Chem. Phys. 104, 1996). A sphere is
/// crystal-like if it has seven such bonds or, with fewer than seven neighbours, six neighbours and all bonds
/// solid-like.
struct BondOrder {
    uint64_t spheres = 0, bonds = 0; ///< measured spheres, and bonds counted from these spheres
    double mean_neighbours = 0;
    double global_q4 = 0, global_q6 = 0; ///< of all bonds together; 1 / sqrt(bonds) where there is no order
    double mean_local_q4 = 0, mean_local_q6 = 0;
    double crystal_fraction = 0; ///< of the measured spheres
    static constexpr double bin_width = 0.01;
    std::vector<uint64_t> local_q4 = std::vector<uint64_t>(100), local_q6 = local_q4; ///< spheres by q in bins from 0
    FabricTensor fabric; ///< of the same bonds
};

/// Measures the bond order; of more than a million bulk spheres, only a block in the middle. number_density: of the
/// bulk. Throws Cancelled.
BondOrder measure_bond_order(const PackedSpheres& spheres, double number_density, const Progress& progress = {});

} // namespace scree
