#include "packing/report/containment.h"

#include "packing/report/ordered_sum.h"
#include "packing/solids/distance_field.h"
#include "packing/solids/domain.h"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr size_t most_told = 10;

struct Part : Containment {
    void keep_worst()
    {
        const auto less = [](const Sphere& a, const Sphere& b) {
            return a.margin != b.margin ? a.margin < b.margin : a.id < b.id;
        };
        const size_t kept = std::min(worst.size(), most_told);
        std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(kept), worst.end(), less);
        worst.resize(kept);
    }
    void add(const Part& other)
    {
        outside += other.outside;
        centre_outside += other.centre_outside;
        asked += other.asked;
        worst.insert(worst.end(), other.worst.begin(), other.worst.end());
        keep_worst();
        for (size_t i = 0; i < margins.size(); ++i) margins[i] += other.margins[i];
    }
};

} // namespace

Containment check_containment(const PackedSpheres& spheres, const Progress& progress)
{
    const Domain& domain = *spheres.mesh().domain;
    const DistanceField& field = *spheres.mesh().field;
    const double last = Containment::bin_first + Containment::bin_width * double(Containment().margins.size());
    return ordered_sum<Part>(spheres.size(), 256, "containment", progress, [&](uint64_t begin, uint64_t end) {
        Part part;
        for (uint64_t i = begin; i < end; ++i) {
            const Imath::V3d& centre = spheres.position(i);
            const double r = spheres.radius(i);
            if (field.signed_distance(centre).lo >= (1 + last) * r) continue;
            ++part.asked;
            const double depth = spheres.depth(centre);
            const bool whole = domain.contains_sphere(centre, r);
            part.outside += !whole;
            part.centre_outside += !whole && depth <= 0;
            const double margin = depth - r,
                         bin = std::floor((margin / r - Containment::bin_first) / Containment::bin_width);
            if (bin < double(part.margins.size())) ++part.margins[static_cast<size_t>(std::max(bin, 0.0))];
            part.worst.push_back({spheres.id(i), centre, r, margin});
        }
        part.keep_worst();
        return part;
    });
}

} // namespace scree
