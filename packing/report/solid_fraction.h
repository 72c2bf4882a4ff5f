#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"

#include <vector>

namespace scree {

/// Which part of a container its spheres fill, by two ways that share nothing but the spheres.
struct SolidFraction {
    double sphere_volume = 0; ///< summed over the spheres in the container; of a bed, over their parts in it
    double all_spheres = 0; ///< the volumes of all spheres, wherever they are
    double container_volume = 0; ///< 0 without container: then nothing else is known
    double by_volume = 0;
    uint64_t points = 0; ///< uniform in the container
    uint64_t hits = 0; ///< of them in any sphere
    double by_points = 0, by_points_error = 0; ///< the latter from the binomial distribution

    /// Of the bulk: by volume, but below the surface of a mesh by the points that fall into it.
    double bulk = 0, bulk_error = 0;
    uint64_t bulk_points = 0, bulk_spheres = 0;
    RadiusMoments bulk_moments; ///< of the spheres whose centres are in the bulk
    double number_density() const { return bulk / bulk_moments.mean_volume(); }
};

/// The fraction along an axis, in bins of one width.
struct FractionProfile {
    std::string name;
    double first = 0, width = 0;
    std::vector<uint64_t> points, hits;
};

/// Throws Cancelled.
SolidFraction measure_fraction(const PackedSpheres& spheres, const Progress& progress = {});

/// Of a mesh: against depth below its surface, in bins of a quarter of the mean radius; else along each axis, between
/// the other axes' bed. Throws Cancelled.
std::vector<FractionProfile> measure_profiles(const PackedSpheres& spheres, const Progress& progress = {});

/// Volume of the part of a ball in a box along the axes, to 1e-3 of the ball.
double ball_in_box(const Imath::V3d& centre, double radius, const Imath::Box3d& box);

} // namespace scree
