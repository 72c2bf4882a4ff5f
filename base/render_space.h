#pragma once

#include "base/math.h"

namespace scree {

/// Position and size of the scene: render coordinates are (x - origin) 2^-exponent, so that the grains fill about
/// -1..1. The scale is a power of two and the origin is subtracted in double, so a scene that is scaled by 2^k, or
/// far from zero, gets the same render coordinates.
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
