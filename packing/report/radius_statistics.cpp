#include "packing/report/radius_statistics.h"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr size_t most_listed = 12, bins = 51; // odd: a single size fills the middle one

} // namespace

RadiusStatistics measure_radii(const PackedSpheres& spheres)
{
    RadiusStatistics result;
    std::vector<double> sorted(spheres.size());
    for (uint64_t i = 0; i < spheres.size(); ++i) sorted[i] = spheres.radius(i);
    std::ranges::sort(sorted);
    const double n = double(sorted.size());
    result.least = sorted.front();
    result.greatest = sorted.back();
    for (const double r : sorted) result.mean += r / n;
    double second = 0, third = 0;
    for (const double r : sorted) {
        const double d = (r - result.mean) / result.greatest;
        second += d * d / n;
        third += d * d * d / n;
    }
    // The deviation of equal radii must be 0, not the rounding of their mean.
    if (result.least < result.greatest) {
        result.deviation = std::sqrt(second) * result.greatest;
        result.skewness = third / std::pow(second, 1.5);
    }
    for (size_t i = 0; i < sorted.size(); ++i) {
        if (i == 0 || sorted[i] != sorted[i - 1]) {
            ++result.distinct;
            if (result.distinct <= most_listed) result.sizes.emplace_back(sorted[i], 0);
        }
        if (result.distinct <= most_listed) ++result.sizes.back().second;
    }
    if (result.distinct > most_listed) result.sizes.clear();

    const double extent = result.greatest - result.least;
    result.bin_width = extent > 0 ? extent / double(bins) : 0.02 * result.greatest;
    result.bin_first = extent > 0 ? result.least : result.least - 0.5 * double(bins) * result.bin_width;
    result.counts.resize(bins);
    for (const double r : sorted)
        ++result.counts[std::min(static_cast<size_t>((r - result.bin_first) / result.bin_width), bins - 1)];
    return result;
}

} // namespace scree
