#pragma once

#include "render/embree/embree_device.h"
#include "render/grains/grain_store.h"

#include <cstdint>
#include <vector>

struct RTCSceneTy;

namespace scree {

struct TracerQuery;

/// Grains of similar size in an Embree scene of their own, relative to their common middle, where a float is precise.
struct SizeClass {
    RTCSceneTy* scene = nullptr;
    std::vector<uint32_t> grains; ///< indices in the world: first the spheres, then the meshes
    uint32_t spheres = 0; ///< number of spheres among them
    V3d centre{0};
    double reach = 0; ///< radius of a sphere around `centre` that contains all of them
    double mesh_reach = 0; ///< the largest diameter of a mesh grain; 0 if there is none
    FloatMargin margin;
};

/// Intersects rays with grains that differ so much in size that no single float ray is precise for all of them.
///
/// The error of Embree's float arithmetic is bounded by the largest sphere and the extent of a scene. So there is an
/// Embree scene for each class of sizes, and a ray starts near each scene that it traverses. With radii from 1e-9 to
/// 1e3 in one world, each grain is hit as precisely as among grains of its own size.
class SizeClasses {
public:
    /// Whether the largest radius is more than `widest` times the smallest.
    static bool are_needed(const GrainStore& grains);

    /// `grains` must outlive this object.
    SizeClasses(const EmbreeDevice& device, const GrainStore& grains);
    ~SizeClasses();
    SizeClasses(const SizeClasses&) = delete;
    SizeClasses& operator=(const SizeClasses&) = delete;

    /// Offers the query the grains that its ray may hit, if they are nearer than its nearest hit.
    void find_nearest(TracerQuery& query) const { find(query, false); }
    /// The same, but stops at the first accepted grain.
    void find_any(TracerQuery& query) const { find(query, true); }

    static constexpr double widest = 0x1p12;

private:
    void find(TracerQuery& query, bool any) const;

    std::vector<SizeClass> classes_;
};

} // namespace scree
