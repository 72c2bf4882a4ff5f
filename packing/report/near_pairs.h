#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"

#include <array>
#include <vector>

namespace scree {

/// Second moment of directions: the mean of n n^T, its eigenvalues, and its deviation from isotropy.
struct FabricTensor {
    uint64_t directions = 0;
    std::array<double, 6> tensor{}; ///< xx, yy, zz, xy, xz, yz; trace 1
    std::array<double, 3> eigenvalues{};
    /// sqrt(3/2 |F - I/3|^2): 0 if isotropic, 1 if all directions are equal; about 1/sqrt(n) for n independent
    /// isotropic directions.
    double deviatoric = 0;
};

/// Computes the tensor from sums of products of unit vectors, in the order of FabricTensor::tensor.
FabricTensor fabric_of(const std::array<double, 6>& sums, uint64_t directions);

/// Statistics of pairs of spheres that overlap, touch, or nearly touch; periodic images form pairs of their own.
struct NearPairs {
    struct Overlap {
        uint64_t ids[2] = {0, 0};
        double overlap = 0; ///< (r_i + r_j - d) / min(r_i, r_j)
        Imath::V3d place{0}; ///< centre of the first
    };

    bool complete = true; ///< false when spheres have thousands of neighbours, and not all were checked
    uint64_t overlapping = 0; ///< pairs with d < r_i + r_j
    double mean_overlap = 0; ///< of those pairs
    double lens_volume = 0; ///< sum of the volumes shared by these pairs
    std::vector<Overlap> worst; ///< up to ten, the largest first
    /// Pairs by overlap, in four bins a decade from 1e-12 to 10; the first bin also holds smaller overlaps.
    static constexpr double log_first = -12, bins_per_decade = 4;
    std::vector<uint64_t> overlap_counts = std::vector<uint64_t>(52);

    /// Spheres touch if their gap over their mean radius is below this.
    static constexpr double contact_tolerance = 1e-3;
    uint64_t bulk_spheres = 0;
    /// Mean number of contacts of a bulk sphere if gaps below 10^(-8 + k/8) mean radii count as contacts, k = 0, 1,
    /// ..., 60.
    static constexpr double log_gap_first = -8, gaps_per_decade = 8;
    std::vector<double> contacts_below_gap = std::vector<double>(61);
    double mean_contacts = 0; ///< of bulk spheres, with gaps below contact_tolerance as contacts
    /// Bulk spheres with fewer than four contacts, removed repeatedly; spheres outside the bulk are never removed.
    uint64_t rattlers = 0;
    double mean_contacts_without_rattlers = 0;
    std::vector<uint64_t> contact_counts; ///< bulk spheres with 0, 1, ... contacts
    FabricTensor fabric; ///< of the contacts with an end in the bulk
};

/// Throws Cancelled.
NearPairs measure_near_pairs(const PackedSpheres& spheres, const Progress& progress = {});

} // namespace scree
