#pragma once

#include "render/trace/region_tracer.h"
#include "render/trace/world.h"

#include <cstdint>
#include <memory>

struct RTCSceneTy;

namespace scree {

enum class HitKind : uint8_t { none, grain, surface, light, medium };

/// What a ray met, or what it starts on: a grain (with the triangle of its mesh), a surface's triangle, a light, or
/// nothing but a medium (which no ray starts on).
struct Place {
    HitKind kind = HitKind::none;
    uint64_t index = 0; ///< grain, surface, light or region
    uint32_t triangle = no_triangle; ///< of a mesh
    uint8_t type = 0; ///< of a grain
};

/// How grains that a ray meets from outside are taken: as they are, by their bounding spheres, which stand for them, or
/// not at all, where a medium stands for them.
enum class GrainDetail : uint8_t { as_is, proxy, none };

struct Hit {
    Place place;
    double t = 0;
    V3d point{0};
    V3d normal{0, 0, 1}; ///< unit, geometric, outwards
};

/// Finds what a ray meets among bounding spheres, the exemplars inside them, surfaces and lights, by Embree.
///
/// Embree proposes in float; spheres are decided in double, and what a ray starts on is known by name and not by an
/// offset. Grains may overlap: outside all grains only faces that the ray enters count, inside one only that grain
/// (and surfaces that cut through it). Rays are (o, d): unit d, render coordinates.
class Tracer {
public:
    /// Builds the acceleration structures of `world`, which must outlive the tracer.
    Tracer(std::shared_ptr<const EmbreeDevice> device, const World& world);
    ~Tracer();

    /// Nearest thing from outside all grains; kind none if there is none. Proxies are met where their sphere is
    /// entered; a grain whose triangle the ray starts on is as it is. beyond: proxies up to there have been met and
    /// missed.
    Hit intersect(const V3d& o, const V3d& d, const Place& from, GrainDetail detail = GrainDetail::as_is,
                  double beyond = 0) const;
    /// Nearest way out of `grain` from inside it, or a surface standing in it. Kind none: lost to rounding, treat as
    /// outside.
    Hit intersect_inside(const Place& grain, const V3d& o, const V3d& d, const Place& from) const;
    /// Whether anything stands between o and o + tmax d; `target` is the light aimed at, which does not count.
    bool occluded(const V3d& o, const V3d& d, double tmax, const Place& from, uint32_t target) const
    {
        return visibility(o, d, tmax, from, target, GrainDetail::as_is) == 0;
    }
    /// The part of light that passes between o and o + tmax d: none, all, or the chance that all proxies on the way are
    /// missed.
    double visibility(const V3d& o, const V3d& d, double tmax, const Place& from, uint32_t target,
                      GrainDetail detail) const;
    /// The surface that cuts the way from a to b, if there is one. For worlds with proxies; others may always say none.
    Hit surface_between(const V3d& a, const V3d& b) const;

    /// A grain whose bounding sphere a place lies in, as met by a ray that passes there along d: t, below 0, is where
    /// it enters the sphere. Kind none: there is no grain. For worlds in which a medium stands for some grains.
    Hit grain_around(const V3d& place, const V3d& d) const;

    /// The surfaces of the media; null where there is no medium.
    const RegionTracer* regions() const;

    /// The scene that `intersect` asks, as Embree's handle: for benchmarks against Embree alone.
    RTCSceneTy* embree_scene() const;
    /// Radius around the render origin of everything but infinite lights.
    double scene_radius() const;

    struct Impl; ///< tracer_impl.h

private:
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
