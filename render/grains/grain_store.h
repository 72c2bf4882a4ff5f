#pragma once

#include "render/math.h"

#include <cstdint>
#include <vector>

namespace scree {

/// The grains of a scene in render coordinates: 16 bytes for the sphere (shared with Embree), 1 or 2 for the type, and
/// 8 for the id only where ids are not consecutive.
///
/// Grains whose shape is the sphere itself come first, then those that are meshes; each part in order of id.
struct GrainStore {
    struct Sphere {
        float x, y, z, r;
    };

    std::vector<Sphere> spheres;         ///< one more entry than grains: Embree reads 16 bytes beyond the last
    std::vector<uint8_t> type_codes;     ///< grain type per grain
    std::vector<uint64_t> ids;           ///< empty when id = first_id + index
    uint64_t first_id = 0;
    std::vector<Imath::Quatf> orientation; ///< of the mesh grains, or empty: then by hash of id
    uint32_t analytic_count = 0;           ///< how many of them are spheres themselves

    uint32_t size() const { return static_cast<uint32_t>(type_codes.size()); }
    uint64_t id(uint32_t grain) const { return ids.empty() ? first_id + grain : ids[grain]; }
    V3d centre(uint32_t grain) const { return {spheres[grain].x, spheres[grain].y, spheres[grain].z}; }
    double radius(uint32_t grain) const { return spheres[grain].r; }
    uint64_t bytes() const
    {
        return spheres.size() * sizeof(Sphere) + type_codes.size() + ids.size() * sizeof(uint64_t) +
               orientation.size() * sizeof(Imath::Quatf);
    }
    /// Rotation of a grain from its own frame to the world's.
    Imath::M33d rotation(uint32_t grain) const;
};

} // namespace scree
