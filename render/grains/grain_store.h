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

/// The margin for errors of Embree's float arithmetic for spheres: radii are widened by some float steps, and rays
/// start a little further back, so that Embree proposes every sphere that the ray really hits.
struct FloatMargin {
    uint32_t ulps = 0; ///< added to the bits of each radius
    bool complete = false; ///< whether Embree proposes every sphere that a ray enters, by its near face
    double step_back = 0; ///< a ray that starts this much further back is outside every widened sphere yet to enter

    FloatMargin() = default;
    /// extent: of the coordinates; least, largest: radii of the smallest and the largest sphere.
    FloatMargin(double extent, double least, double largest);

    float widen(float radius) const { return std::bit_cast<float>(std::bit_cast<uint32_t>(radius) + ulps); }
    float narrow(float radius) const { return std::bit_cast<float>(std::bit_cast<uint32_t>(radius) - ulps); }
};

/// The grains of a scene in render coordinates: 16 bytes for the sphere (shared with Embree), 1 for the type, and 8 for
/// the id, the latter only if ids are not consecutive.
///
/// Grains whose shape is the sphere itself come first, then grains with meshes; each part is in order of id.
struct GrainStore {
    struct Sphere {
        float x, y, z;
        float r; ///< the radius for Embree: wider than the grain's by `margin`
    };

    std::vector<Sphere> spheres; ///< one more entry than grains: Embree reads 16 bytes beyond the last
    std::vector<uint8_t> type_codes; ///< grain type per grain
    std::vector<uint64_t> ids; ///< empty when id = first_id + index
    uint64_t first_id = 0;
    std::vector<Imath::Quatf> orientation; ///< of the mesh grains; if empty, the hash of the id gives the orientation
    uint32_t analytic_count = 0; ///< number of grains whose shape is the sphere itself
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
    /// Sets the margin and widens the radii by it; call it once, after all grains are added.
    void widen();
};

} // namespace scree
