#pragma once

#include "base/progress.h"
#include "packing/report/packed_spheres.h"

#include <vector>

namespace scree {

/// The part of a container that its spheres fill, by two independent methods.
struct SolidFraction {
    double sphere_volume = 0; ///< of the spheres in the container; for a bed, of their parts inside the bed
    double all_spheres = 0; ///< volume of all spheres, wherever they are
    double container_volume = 0; ///< 0 without a container: then the values below are unknown
    double by_volume = 0;
    uint64_t points = 0; ///< uniform in the container
    uint64_t hits = 0; ///< number of these points that lie in a sphere
    double by_points = 0, by_points_error = 0; ///< the error follows from the binomial distribution

    /// Fraction of the bulk: by volume, except in a mesh, where it is by the random points that fall into the bulk.
    double bulk = 0, bulk_error = 0;
    uint64_t bulk_points = 0, bulk_spheres = 0;
    RadiusMoments bulk_moments; ///< of the spheres whose centres are in the bulk
    double number_density() const { return bulk / bulk_moments.mean_volume(); }
};

/// The fraction along an axis, in bins of equal width.
struct FractionProfile {
    std::string name;
    double first = 0, width = 0;
    std::vector<uint64_t> points, hits;
};

/// Measures the fraction of the container and of the bulk. Throws Cancelled.
SolidFraction measure_fraction(const PackedSpheres& spheres, const Progress& progress = {});

/// Measures profiles: for a mesh, against the depth below its surface, in bins of a quarter of the mean radius; else
/// along each axis, within the bed of the other axes. Throws Cancelled.
std::vector<FractionProfile> measure_profiles(const PackedSpheres& spheres, const Progress& progress = {});

/// Volume of the part of a ball that lies in an axis-aligned box, to 1e-3 of the ball.
double ball_in_box(const Imath::V3d& centre, double radius, const Imath::Box3d& box);

} // namespace scree
