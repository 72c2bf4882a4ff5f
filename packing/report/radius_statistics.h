#pragma once

#include "packing/report/packed_spheres.h"

#include <utility>
#include <vector>

namespace scree {

/// The distribution of the radii, by number.
struct RadiusStatistics {
    double least = 0, greatest = 0, mean = 0, deviation = 0, skewness = 0;
    uint64_t distinct = 0; ///< number of different values
    std::vector<std::pair<double, uint64_t>>
        sizes; ///< the values and their spheres, ascending, where there are at most 12
    double bin_first = 0, bin_width = 0;
    std::vector<uint64_t> counts;
};

RadiusStatistics measure_radii(const PackedSpheres& spheres);

} // namespace scree
