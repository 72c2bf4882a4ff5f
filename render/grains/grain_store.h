#pragma once

#include "base/math.h"

#include <bit>
#include <cstdint>
#include <vector>

namespace scree {

/// A grain's bounding sphere in render coordinates.
struct GrainSphere {
    V3d centre;
    double radius;
};

/// What Embree's arithmetic in float may get wrong of spheres, and what makes it propose every one whose ray really
/// meets it: radii widened by some steps of float, and rays that start a little further back.
struct FloatMargin {
    uint32_t ulps = 0; ///< added to the bits of each radius
    bool complete = false; ///< every sphere that a ray is to enter is proposed by its near face
    double step_back = 0; ///< beyond which a ray's start is outside of every widened sphere that it is yet to enter

    FloatMargin() = default;
    /// extent: of the coordinates; radii of the smallest and largest sphere.
    FloatMargin(double extent, double least, double largest);

    float widen(float radius) const { return std::bit_cast<float>(std::bit_cast<uint32_t>(radius) + ulps); }
    float narrow(float radius) const { return std::bit_cast<float>(std::bit_cast<uint32_t>(radius) - ulps); }
};

/// The grains of a scene in render coordinates: 16 bytes for the sphere (shared with Embree), 1 or 2 for the type, and
/// 8 for the id only where ids are not consecutive.
///
/// Grains whose shape is the sphere itself come first, then those that are meshes; each part in order of id.
struct GrainStore {
    struct Sphere {
        float x, y, z;
        float r; ///< as Embree is to see it: `margin` wider than the grain
    };

    std::vector<Sphere> spheres; ///< one more entry than grains: Embree reads 16 bytes beyond the last
    std::vector<uint8_t> type_codes; ///< grain type per grain
    std::vector<uint64_t> ids; ///< empty when id = first_id + index
    uint64_t first_id = 0;
    std::vector<Imath::Quatf> orientation; ///< of the mesh grains, or empty: then by hash of id
    uint32_t analytic_count = 0; ///< how many of them are spheres themselves
    FloatMargin margin;

    uint32_t size() const { return static_cast<uint32_t>(type_codes.size()); }
    uint64_t id(uint64_t grain) const { return ids.empty() ? first_id + grain : ids[grain]; }
    V3d centre(uint64_t grain) const { return {spheres[grain].x, spheres[grain].y, spheres[grain].z}; }
    double radius(uint64_t grain) const { return margin.narrow(spheres[grain].r); }
    uint64_t bytes() const
    {
        return spheres.size() * sizeof(Sphere) + type_codes.size() + ids.size() * sizeof(uint64_t) +
               orientation.size() * sizeof(Imath::Quatf);
    }
    /// Sets the margin and widens the radii by it; once, when all grains are in.
    void widen();
};

} // namespace scree
