#pragma once

#include "base/math.h"
#include "ingest/meshes/triangle_mesh.h"
#include "render/embree/embree_device.h"

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

struct RTCSceneTy;

namespace scree {

/// Which faces a ray may hit: from outside a grain those through which it enters, from inside those through which it
/// leaves.
enum class Facing : uint8_t { entering, leaving };

inline constexpr uint32_t no_triangle = std::numeric_limits<uint32_t>::max();

struct ExemplarHit {
    double t = 0; ///< along the ray, in units of the bounding sphere's radius
    uint32_t triangle = no_triangle;
    float u = 0, v = 0; ///< barycentric coordinates, as Embree defines them
};

/// The shape of a grain type as a triangle mesh inside the unit sphere, with its own BVH; traced in the grain's frame.
///
/// Closed meshes are turned outwards. Open meshes (leaves, fibres) have faces that rays hit from both sides.
class Exemplar {
public:
    /// Moves and scales the mesh into the unit sphere around the centre of its smallest enclosing sphere.
    /// Throws InputError naming `place` when the mesh has no extent.
    Exemplar(const EmbreeDevice& device, const TriangleMesh& mesh, const std::string& place);
    ~Exemplar();
    Exemplar(const Exemplar&) = delete;
    Exemplar& operator=(const Exemplar&) = delete;

    /// Finds the nearest face of the given facing along o + t d, 0 <= t <= tmax; returns false if there is none. o: in
    /// or on the unit sphere; d: unit; skip: the face on which o lies, if any; rounding: how far o may lie off it.
    bool intersect(const V3d& o, const V3d& d, double rounding, double tmax, Facing facing, uint32_t skip,
                   ExemplarHit& hit) const;

    /// The point of a hit, computed from the vertices in double.
    V3d point(const ExemplarHit& hit) const;
    /// Unit geometric normal, outwards for a closed mesh.
    V3d normal(uint32_t triangle) const;
    std::array<V3d, 3> corners(uint32_t triangle) const;

    bool closed() const { return closed_; }
    uint64_t triangle_count() const { return corners_.size(); }
    uint64_t bytes() const;

private:
    std::vector<std::array<V3f, 3>> corners_; // per triangle, side by side because access is random
    bool closed_ = false;
    RTCSceneTy* scene_ = nullptr;
};

} // namespace scree
