#pragma once

#include "render/trace/region_tracer.h"
#include "render/trace/world.h"

#include <cstdint>
#include <memory>

struct RTCSceneTy;

namespace scree {

enum class HitKind : uint8_t { none, grain, surface, light, medium };

/// What a ray hits or starts on: a grain (with the triangle of its mesh), a surface's triangle, a light, or a medium
/// (on which no ray starts).
struct Place {
    HitKind kind = HitKind::none;
    uint64_t index = 0; ///< grain, surface, light or region
    uint32_t triangle = no_triangle; ///< triangle of a mesh
    uint8_t type = 0; ///< type of a grain
};

/// How grains are represented for rays from outside: as explicit geometry (as_is), by their bounding spheres as
/// proxies, or not at all (none), where a medium replaces them.
enum class GrainDetail : uint8_t { as_is, proxy, none };

struct Hit {
    Place place;
    double t = 0;
    V3d point{0};
    V3d normal{0, 0, 1}; ///< unit, geometric, outwards
};

/// Intersects rays with bounding spheres, the exemplars inside them, surfaces and lights, using Embree.
///
/// Embree proposes hits in float; hits of spheres are decided in double. The primitive on which a ray starts is known
/// by its index, so that no offset is needed. Grains may overlap: outside all grains, only faces that the ray enters
/// count; inside a grain, only that grain counts (and surfaces that cut through it). Rays are (o, d): unit d, render
/// coordinates.
class Tracer {
public:
    /// Builds the acceleration structures of `world`, which must outlive the tracer.
    Tracer(std::shared_ptr<const EmbreeDevice> device, const World& world);
    ~Tracer();

    /// The nearest hit of a ray that starts outside all grains; kind none if there is none. A proxy is hit where the
    /// ray enters its sphere; a grain on whose triangle the ray starts counts as explicit geometry. beyond: proxies
    /// entered at t up to this distance are ignored, as the ray has already passed through them.
    Hit intersect(const V3d& o, const V3d& d, const Place& from, GrainDetail detail = GrainDetail::as_is,
                  double beyond = 0) const;
    /// The nearest exit from `grain` for a ray inside it, or a surface inside the grain if that is nearer. Kind none:
    /// the exit was lost to rounding; treat the ray as outside.
    Hit intersect_inside(const Place& grain, const V3d& o, const V3d& d, const Place& from) const;
    /// Whether anything blocks the ray between o and o + tmax d; `target` is the light aimed at, which does not count.
    bool occluded(const V3d& o, const V3d& d, double tmax, const Place& from, uint32_t target) const
    {
        return visibility(o, d, tmax, from, target, GrainDetail::as_is) == 0;
    }
    /// The part of the light that passes between o and o + tmax d: 0, 1, or the probability of passing straight through
    /// all proxies on the path (the product of their alpha0).
    double visibility(const V3d& o, const V3d& d, double tmax, const Place& from, uint32_t target,
                      GrainDetail detail) const;
    /// The surface that cuts the segment from a to b, if there is one. For worlds with proxies; for other worlds the
    /// result may always be none.
    Hit surface_between(const V3d& a, const V3d& b) const;

    /// A grain whose bounding sphere contains a point, as hit by a ray through the point along d: t, below 0, is where
    /// the ray enters the sphere. Kind none: there is no such grain. For worlds in which a medium replaces some grains.
    Hit grain_around(const V3d& place, const V3d& d) const;

    /// The surfaces of the media; null where there is no medium.
    const RegionTracer* regions() const;

    /// The Embree scene that `intersect` uses: for benchmarks against Embree alone.
    RTCSceneTy* embree_scene() const;
    /// Radius around the render origin of everything but infinite lights.
    double scene_radius() const;

    struct Impl; ///< tracer_impl.h

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
