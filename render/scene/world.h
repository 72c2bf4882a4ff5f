#pragma once

#include "render/grains/exemplar.h"
#include "render/grains/grain_store.h"
#include "render/lights/light.h"
#include "render/materials/material.h"
#include "render/math.h"

#include <memory>
#include <string>
#include <vector>

namespace scree {

/// Where and how large the scene is: render coordinates are (x - origin) 2^-exponent, so that the grains fill about
/// -1..1. Powers of two and a centring in double make a scene scaled by 2^k, or far from zero, the same numbers.
struct RenderSpace {
    V3d origin{0};
    int exponent = 0;

    V3d point(const V3d& world) const { return V3d(length(world.x - origin.x), length(world.y - origin.y), length(world.z - origin.z)); }
    V3d vector(const V3d& world) const { return V3d(length(world.x), length(world.y), length(world.z)); }
    double length(double world) const { return std::ldexp(world, -exponent); }
    double world_length(double render) const { return std::ldexp(render, exponent); }
    V3d world_point(const V3d& p) const
    {
        return V3d(world_length(p.x), world_length(p.y), world_length(p.z)) + origin;
    }
};

/// A grain type ready for tracing: without an exemplar its shape is the bounding sphere itself.
struct GrainType {
    std::string name;
    Material material;                  ///< absorption in render coordinates
    std::shared_ptr<const Exemplar> exemplar;
};

/// Triangles of the scene that are no grains, in render coordinates.
struct Surface {
    std::string name;
    std::vector<V3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
    Material material;
};

/// Everything light can meet, in render coordinates.
struct World {
    RenderSpace space;
    GrainStore grains;
    std::vector<GrainType> types;
    std::vector<Surface> surfaces;
    LightSet lights;

    const Material& material_of(uint32_t grain) const { return types[grains.type_codes[grain]].material; }
};

} // namespace scree
