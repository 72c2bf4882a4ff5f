#pragma once

#include "render/embree/embree_device.h"
#include "render/grains/grain_store.h"

#include <cstdint>
#include <vector>

struct RTCSceneTy;

namespace scree {

struct TracerQuery;

/// Grains of about one size, as Embree sees them: about their own middle, where a float is precise.
struct SizeClass {
    RTCSceneTy* scene = nullptr;
    std::vector<uint32_t> grains; ///< of the world: those that are spheres, then those that are meshes
    uint32_t spheres = 0; ///< how many of them are spheres
    V3d centre{0};
    double reach = 0; ///< radius of a sphere around `centre` that holds them all
    double mesh_reach = 0; ///< the largest diameter of a mesh grain, 0 without
    FloatMargin margin;
};

/// Finds what a ray meets among grains that differ so much in size that no one float ray is precise for all of them.
///
/// What Embree's float arithmetic may get wrong is bounded by the largest sphere and the extent of a scene. So there is
/// an Embree scene for each class of sizes, and a ray is asked of it from where it comes near: from 1e-9 to 1e3 in one
/// scene, each grain is met as if it were alone with its like.
class SizeClasses {
public:
    /// Whether the largest of the grains is beyond `widest` of the smallest.
    static bool are_needed(const GrainStore& grains);

    /// `grains` outlive this.
    SizeClasses(const EmbreeDevice& device, const GrainStore& grains);
    ~SizeClasses();
    SizeClasses(const SizeClasses&) = delete;
    SizeClasses& operator=(const SizeClasses&) = delete;

    /// Offers the query the grains its ray may meet, nearer than what it has.
    void find_nearest(TracerQuery& query) const { find(query, false); }
    /// The same until there is one.
    void find_any(TracerQuery& query) const { find(query, true); }

    static constexpr double widest = 0x1p12;

private:
    void find(TracerQuery& query, bool any) const;

    std::vector<SizeClass> classes_;
};

} // namespace scree
