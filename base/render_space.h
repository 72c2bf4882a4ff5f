#pragma once

#include "base/math.h"

namespace scree {

/// Where and how large the scene is: render coordinates are (x - origin) 2^-exponent, so that the grains fill about
/// -1..1. Powers of two and a centring in double make a scene scaled by 2^k, or far from zero, the same numbers.
struct RenderSpace {
    V3d origin{0};
    int exponent = 0;

    V3d point(const V3d& world) const
    {
        return V3d(length(world.x - origin.x), length(world.y - origin.y), length(world.z - origin.z));
    }
    V3d vector(const V3d& world) const { return V3d(length(world.x), length(world.y), length(world.z)); }
    double length(double world) const { return std::ldexp(world, -exponent); }
    double world_length(double render) const { return std::ldexp(render, exponent); }
    V3d world_point(const V3d& p) const
    {
        return V3d(world_length(p.x), world_length(p.y), world_length(p.z)) + origin;
    }
};

} // namespace scree
