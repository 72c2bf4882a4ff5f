#include "render/grains/library/half_spaces.h"
#include "render/grains/library/radial_surface.h"
#include "render/grains/library/shape_generator.h"
#include "render/grains/library/shape_random.h"

#include "base/noise.h"

namespace scree {

namespace {

/// A shell-shaped (conchoidal) break: a sphere with its centre outside the grain cuts a piece off.
struct Scoop {
    V3d center;
    double radius;

    /// Where the ray from the origin enters the sphere, or infinity.
    double entry(const V3d& d) const
    {
        const double b = center.dot(d), discriminant = b * b - center.length2() + radius * radius;
        return b > 0 && discriminant > 0 ? b - std::sqrt(discriminant) : std::numeric_limits<double>::infinity();
    }
};

/// Directions apart from each other: each is, of six random ones, the farthest from the directions before.
std::vector<V3d> spread_directions(size_t count, ShapeRandom& random)
{
    std::vector<V3d> directions;
    while (directions.size() < count) {
        V3d best(0);
        double best_cosine = 2;
        for (int trial = 0; trial < 6; ++trial) {
            const V3d d = random.direction();
            double nearest = -1;
            for (const V3d& other : directions) nearest = std::max(nearest, d.dot(other));
            if (nearest < best_cosine) {
                best = d;
                best_cosine = nearest;
            }
        }
        directions.push_back(best);
    }
    return directions;
}

} // namespace

TriangleMesh make_pebble(const ShapeRequest& request)
{
    ShapeRandom random(request.seed, 0x706562);
    const double middle = request["middle_axis"] * (1 + 0.1 * random.uniform(-1, 1));
    const double least = request["short_axis"] * (1 + 0.1 * random.uniform(-1, 1));
    const V3d axes(1, std::min(1.0, middle), std::min({1.0, middle, least}));

    std::vector<HalfSpace> planes;
    for (const V3d& n : spread_directions(static_cast<size_t>(request["facets"]), random)) {
        planes.push_back({n, 1 - request["angularity"] * random.uniform(0.35, 1)});
    }
    const double rounding = request["rounding"], p = 1 / rounding;
    const auto cut_sphere = [&](const V3d& d) {
        double sum = 1;
        for (const HalfSpace& plane : planes) {
            const double term = plane.normal.dot(d) / plane.distance;
            if (term > 0) sum += std::pow(term, p);
        }
        return std::pow(sum, -rounding);
    };
    std::vector<Scoop> scoops;
    for (const V3d& n : spread_directions(static_cast<size_t>(request["breaks"]), random)) {
        // The radius is far above the depth, so that no ray touches the sphere's rim inside the grain and the surface
        // has no step.
        const double radius = random.uniform(1.4, 2.6), depth = request["break_depth"] * random.uniform(0.5, 1);
        scoops.push_back({n * (cut_sphere(n) - depth + radius), radius});
    }

    NoiseOptions bumps;
    bumps.scale = V3d(request["bump_size"]);
    bumps.octaves = 1 + static_cast<int>(
                            std::clamp(std::log2(0.5 * request["bump_size"] / mean_edge(request.triangles)), 0.0, 6.0));
    bumps.gain = 0.65;
    bumps.seed = random.next();
    const FractalNoise noise(bumps);
    const double roughness = request["roughness"];
    const RadialFunction radius = [&](const V3d& d) {
        // In the space where the ellipsoid is the unit sphere.
        const V3d stretched(d.x / axes.x, d.y / axes.y, d.z / axes.z);
        const double length = stretched.length();
        const V3d u = stretched / length;
        double r = cut_sphere(u);
        for (const Scoop& scoop : scoops) r = std::min(r, scoop.entry(u));
        r /= length;
        return r * (1 + roughness * noise(r * d));
    };
    return radial_surface(radius, request.triangles);
}

} // namespace scree
