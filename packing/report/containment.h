#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"

#include <vector>

namespace scree {

/// Whether every sphere is wholly inside the mesh.
struct Containment {
    struct Sphere {
        uint64_t id = 0;
        Imath::V3d position{0};
        double radius = 0;
        double margin =
            0; ///< signed distance of the centre from the surface minus the radius: negative if it sticks out
    };

    uint64_t outside = 0; ///< spheres that are not wholly inside, decided exactly
    uint64_t centre_outside = 0; ///< of these, spheres whose centre is outside
    uint64_t asked = 0; ///< spheres so near the surface that the exact test was needed
    std::vector<Sphere> worst; ///< up to ten of the exactly tested spheres, by ascending margin

    /// Spheres by margin over radius, in bins of 0.1 from -1 up; values beyond the last bin are left out.
    static constexpr double bin_first = -1, bin_width = 0.1;
    std::vector<uint64_t> margins = std::vector<uint64_t>(40);
};

/// Tests every sphere; the container must be a mesh. Throws Cancelled.
Containment check_containment(const PackedSpheres& spheres, const Progress& progress = {});

} // namespace scree
