#include "packing/report/solid_fraction.h"

#include "base/hash.h"
#include "packing/report/ordered_sum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace scree {

using Imath::V3d;

namespace {

constexpr uint64_t point_count = uint64_t{1} << 20, chunk_size = uint64_t{1} << 13;
constexpr uint64_t fraction_seed = 0x66726163, profile_seed = 0x70726f66;
constexpr double depth_in_radii = 12, bins_per_radius = 4;

struct PointCounts {
    uint64_t hits = 0, bulk_points = 0, bulk_hits = 0;
    void add(const PointCounts& other)
    {
        hits += other.hits;
        bulk_points += other.bulk_points;
        bulk_hits += other.bulk_hits;
    }
};

struct BulkSpheres {
    uint64_t count = 0;
    double volume = 0, sum[7] = {};
    void add(const BulkSpheres& other)
    {
        count += other.count;
        volume += other.volume;
        for (int k = 1; k <= 6; ++k) sum[k] += other.sum[k];
    }
};

struct ProfileCounts {
    std::vector<uint64_t> points, hits;
    void add(const ProfileCounts& other)
    {
        points.resize(std::max(points.size(), other.points.size()));
        hits.resize(points.size());
        for (size_t i = 0; i < other.points.size(); ++i) {
            points[i] += other.points[i];
            hits[i] += other.hits[i];
        }
    }
};

double binomial_error(double p, uint64_t n) { return n > 0 ? std::sqrt(p * (1 - p) / double(n)) : 0; }

FractionProfile depth_profile(const PackedSpheres& spheres, const Progress& progress)
{
    const size_t bins = static_cast<size_t>(depth_in_radii * bins_per_radius);
    const double width = spheres.moments().m[1] / bins_per_radius;
    // Exact distances are expensive, and an error of one per cent per bin is not visible.
    ProfileCounts counts = ordered_sum<ProfileCounts>(
        point_count / 8, chunk_size / 8, "fraction against depth", progress, [&](uint64_t begin, uint64_t end) {
            ProfileCounts part{std::vector<uint64_t>(bins), std::vector<uint64_t>(bins)};
            for (uint64_t i = begin; i < end; ++i) {
                const V3d place = spheres.sample(i, profile_seed);
                const double depth = spheres.depth(place) / width;
                if (!(depth >= 0 && depth < double(bins))) continue;
                ++part.points[static_cast<size_t>(depth)];
                part.hits[static_cast<size_t>(depth)] += spheres.covered(place);
            }
            return part;
        });
    while (!counts.points.empty() && counts.points.back() == 0) {
        counts.points.pop_back();
        counts.hits.pop_back();
    }
    return {"depth", 0, width, std::move(counts.points), std::move(counts.hits)};
}

/// Measures the profile along axis k of the periodic box or of space.
FractionProfile axis_profile(const PackedSpheres& spheres, size_t k, const Progress& progress)
{
    const bool box = spheres.container() == PackedSpheres::Container::periodic_box;
    const int axis = static_cast<int>(k);
    const Imath::Box3d& bounds = spheres.endless(k) ? spheres.bed() : spheres.bounds();
    const double extent = box ? spheres.edges()[k].length() : bounds.max[axis] - bounds.min[axis];
    const size_t bins = static_cast<size_t>(std::clamp(extent * bins_per_radius / spheres.moments().m[1], 4.0, 128.0));
    ProfileCounts counts = ordered_sum<ProfileCounts>(
        point_count / 4, chunk_size, "fraction along the axes", progress, [&](uint64_t begin, uint64_t end) {
            ProfileCounts part{std::vector<uint64_t>(bins), std::vector<uint64_t>(bins)};
            for (uint64_t i = begin; i < end; ++i) {
                V3d place = spheres.sample(i, profile_seed + k);
                double u = 0;
                if (box) {
                    u = spheres.fractional(place)[axis];
                } else {
                    u = unit_double(hash_index(i, profile_seed + k, 3));
                    place[axis] = bounds.min[axis] + u * extent;
                }
                const size_t bin = std::min(static_cast<size_t>(u * double(bins)), bins - 1);
                ++part.points[bin];
                part.hits[bin] += spheres.covered(place);
            }
            return part;
        });
    const std::string name(1, box ? "abc"[k] : "xyz"[k]);
    return {name, box ? 0 : bounds.min[axis], extent / double(bins), std::move(counts.points), std::move(counts.hits)};
}

} // namespace

double ball_in_box(const V3d& centre, double radius, const Imath::Box3d& box)
{
    V3d lo = box.min - centre, hi = box.max - centre;
    bool whole = true;
    for (int axis = 0; axis < 3; ++axis) {
        if (lo[axis] >= radius || hi[axis] <= -radius) return 0;
        whole = whole && lo[axis] <= -radius && hi[axis] >= radius;
        lo[axis] = std::max(lo[axis], -radius);
        hi[axis] = std::min(hi[axis], radius);
    }
    if (whole) return 4.0 / 3 * std::numbers::pi * radius * radius * radius;
    constexpr int columns = 64;
    const double dx = (hi.x - lo.x) / columns, dy = (hi.y - lo.y) / columns;
    double sum = 0;
    for (int i = 0; i < columns; ++i) {
        const double x = lo.x + (i + 0.5) * dx;
        for (int j = 0; j < columns; ++j) {
            const double y = lo.y + (j + 0.5) * dy, h2 = radius * radius - x * x - y * y;
            if (h2 > 0) sum += std::max(0.0, std::min(hi.z, std::sqrt(h2)) - std::max(lo.z, -std::sqrt(h2)));
        }
    }
    return sum * dx * dy;
}

SolidFraction measure_fraction(const PackedSpheres& spheres, const Progress& progress)
{
    using Container = PackedSpheres::Container;
    const Container container = spheres.container();
    SolidFraction result;
    result.container_volume = spheres.volume();
    Imath::Box3d bed = spheres.bed();
    if (container == Container::bed) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!spheres.endless(static_cast<size_t>(axis))) continue;
            bed.min[axis] = -std::numeric_limits<double>::infinity();
            bed.max[axis] = std::numeric_limits<double>::infinity();
        }
    }
    const double unit = spheres.largest_radius();
    const BulkSpheres bulk = ordered_sum<BulkSpheres>(
        spheres.size(), chunk_size, "sum of volumes", progress, [&](uint64_t begin, uint64_t end) {
            BulkSpheres part;
            for (uint64_t i = begin; i < end; ++i) {
                const double r = spheres.radius(i);
                part.volume += container == Container::bed ? ball_in_box(spheres.position(i), r, bed)
                                                           : 4.0 / 3 * std::numbers::pi * r * r * r;
                if (!spheres.bulk(i)) continue;
                ++part.count;
                double power = 1;
                for (int k = 1; k <= 6; ++k) part.sum[k] += power *= r / unit;
            }
            return part;
        });
    result.sphere_volume = bulk.volume;
    result.all_spheres = double(spheres.size()) * spheres.moments().mean_volume();
    result.bulk_spheres = bulk.count;
    if (container == Container::none) return result;
    for (int k = 1; k <= 6 && bulk.count > 0; ++k)
        result.bulk_moments.m[k] = bulk.sum[k] / double(bulk.count) * std::pow(unit, k);
    result.by_volume = result.sphere_volume / result.container_volume;

    result.points = point_count;
    const PointCounts counts = ordered_sum<PointCounts>(
        point_count, chunk_size, "hits of random points", progress, [&](uint64_t begin, uint64_t end) {
            PointCounts part;
            for (uint64_t i = begin; i < end; ++i) {
                const V3d place = spheres.sample(i, fraction_seed);
                const bool hit = spheres.covered(place), inner = spheres.in_bulk(place);
                part.hits += hit;
                part.bulk_points += inner;
                part.bulk_hits += hit && inner;
            }
            return part;
        });
    result.hits = counts.hits;
    result.by_points = double(counts.hits) / double(point_count);
    result.by_points_error = binomial_error(result.by_points, point_count);
    result.bulk_points = counts.bulk_points;
    if (counts.bulk_points > 0) {
        result.bulk = double(counts.bulk_hits) / double(counts.bulk_points);
        result.bulk_error = binomial_error(result.bulk, counts.bulk_points);
    }
    if (container != Container::mesh) { // all of it is bulk, and the spheres' volumes in it are known
        result.bulk = result.by_volume;
        result.bulk_error = 0;
    }
    return result;
}

std::vector<FractionProfile> measure_profiles(const PackedSpheres& spheres, const Progress& progress)
{
    using Container = PackedSpheres::Container;
    if (spheres.container() == Container::none) return {};
    if (spheres.container() == Container::mesh) return {depth_profile(spheres, progress)};
    std::vector<FractionProfile> result;
    for (size_t k = 0; k < 3; ++k) result.push_back(axis_profile(spheres, k, progress));
    return result;
}

} // namespace scree
