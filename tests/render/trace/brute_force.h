#pragma once

#include "base/sampler.h"
#include "render/trace/tracer.h"

#include <array>
#include <limits>
#include <vector>

namespace scree {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double float_margin =
    0x1p-20; ///< error of rays in render coordinates of size 1: a few roundings of 2^-24

V3d random_direction(Sampler& sampler);
/// A random point in the cube of half edge `half` around 0.
V3d random_point(Sampler& sampler, double half);

/// The brute-force result for one ray: the nearest hit, and whether another answer is so close that rounding to float
/// may decide.
struct Truth {
    Place place;
    double t = infinity, second = infinity;
    bool close = false;
    double doubtful = infinity; ///< distance of the nearest thing grazed

    void offer(const Place& candidate, double at)
    {
        if (at >= t) {
            second = std::min(second, at);
            return;
        }
        second = t;
        t = at;
        place = candidate;
    }
    void doubt(double at) { doubtful = std::min(doubtful, at); }
    /// Call after the last offer.
    void judge() { close = std::min(doubtful, second) < t + float_margin; }
};

/// Corners in render coordinates, in double.
std::array<V3d, 3> grain_triangle(const World& world, uint32_t grain, uint32_t triangle);
std::array<V3d, 3> surface_triangle(const World& world, uint32_t surface, uint32_t triangle);

/// The expected hits of a tracer, by testing every sphere and every triangle in double.
class BruteForce {
public:
    explicit BruteForce(const World& world);

    /// From outside all grains: spheres and mesh faces that the ray enters, surfaces from both sides.
    Truth outside(const V3d& o, const V3d& d, const Place& from) const;
    /// From inside one grain, on its way out or to a surface.
    Truth inside(uint32_t grain, const V3d& o, const V3d& d, const Place& from) const;

private:
    struct Triangle {
        Place place;
        std::array<V3d, 3> c;
        V3d normal;
        double height; ///< smallest height of the triangle: the least length of one barycentric unit
    };
    void add(const Place& place, const std::array<V3d, 3>& c);
    void try_sphere(uint32_t i, const V3d& o, const V3d& d, const Place& from, Truth& truth) const;
    static void try_triangle(const Triangle& triangle, bool entering, const V3d& o, const V3d& d, const Place& from,
                             Truth& truth);

    const World& world_;
    std::vector<Triangle> triangles_; // of grains, then of surfaces
    std::vector<size_t> first_of_grain_;
};

} // namespace scree
