#pragma once

// Private to the tracer: the only header of ours that sees Embree.

#include "render/trace/fill_tracer.h"
#include "render/trace/size_classes.h"
#include "render/trace/tracer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <vector>

namespace scree {

inline constexpr uint32_t no_light = std::numeric_limits<uint32_t>::max();

struct Tracer::Impl {
    // Geometry ids in the outer scene; surfaces follow from first_surface, then lights, a geometry each.
    static constexpr uint32_t analytic_id = 0, mesh_id = 1, first_surface = 2;

    std::shared_ptr<const EmbreeDevice> device;
    const World& world;
    RTCScene scene = nullptr; // everything
    RTCScene open_scene = nullptr; // everything but grains, where a medium stands for some; else null
    RTCScene surface_scene = nullptr; // surfaces alone, for rays inside grains; null when no ray can be inside one
    uint32_t first_light = first_surface;
    std::vector<uint32_t> light_of_id; // geometry id - first_light -> light
    double largest_radius = 0; // of a grain, where a medium stands for some
    double mesh_reach = 0; // the largest diameter of a mesh grain: how far on a sphere around a ray's start ends
    double radius = 0;
    std::unique_ptr<const RegionTracer> regions; // where there are media
    std::unique_ptr<const SizeClasses> sizes; // where grains differ so much in size that `scene` is without them
    std::unique_ptr<const FillTracer>
        fill; // where the grains are those of a fill: the scene then has surfaces and lights

    Impl(std::shared_ptr<const EmbreeDevice> device, const World& world);
    ~Impl();

    /// How far Embree's rays in `scene` start before a ray's own start.
    double step_back() const { return sizes ? 0 : world.margin().step_back; }
    RTCScene scene_with(GrainDetail detail) const
    {
        return detail == GrainDetail::none && open_scene ? open_scene : scene;
    }
    bool is_surface(uint32_t id) const { return id >= first_surface && id < first_light; }
    uint32_t light_of(uint32_t id) const { return light_of_id[id - first_light]; }

private:
    void attach_grains(uint32_t id, size_t begin, size_t count);
    RTCGeometry make_surface(const Surface& surface) const;
    RTCGeometry make_light(const Light& light) const;
    void attach(RTCScene to, RTCGeometry geometry, uint32_t id) const;
};

/// What a ray carries through Embree to the filters, and the nearest thing they have accepted.
struct TracerQuery {
    RTCIntersectContext context; // first: Embree hands it back
    const Tracer::Impl* tracer;
    const SizeClass* sized = nullptr; // whose scene Embree is asked; null: the tracer's
    V3d o, d;
    double advanced = 0; // Embree's ray starts at o + advanced d
    double reach = 0; // Embree's ray is never shorter, so that every sphere around its start is proposed
    Place from;
    uint32_t target = no_light; // a light that does not count
    bool proxies = false; // grains count as their bounding spheres
    bool attenuates = false; // proxies let light through, and do not count when they let all of it
    const V3d* around = nullptr; // only spheres that this place lies in count
    double passed = 1; // by the proxies so far
    double beyond = 0; // proxies up to there do not count
    double best = std::numeric_limits<double>::infinity(); // from o; nothing farther is accepted
    Place place; // of the nearest
    float u = 0, v = 0; // on its triangle

    TracerQuery(const Tracer::Impl& impl, const V3d& o_, const V3d& d_, const Place& from_)
        : tracer(&impl), o(o_), d(d_), from(from_)
    {
        rtcInitIntersectContext(&context);
    }

    /// Where Embree's ray may end.
    float embree_end() const { return static_cast<float>(std::max(best - advanced, reach)); }
    /// Takes what is met at t, if that is nearer than best.
    bool offer(const Place& what, double t);
    /// Whether the bounding sphere of a grain stands for it.
    bool is_proxy(uint64_t grain) const
    {
        return proxies && !(from.kind == HitKind::grain && from.index == grain && from.triangle != no_triangle);
    }
    /// Takes a sphere that is entered at t, if that is nearer than best; one that only attenuates is not taken.
    bool offer_sphere(const Place& grain, const GrainSphere& sphere, double t);
    /// Traces the mesh of a grain from o, outside; takes a hit nearer than best.
    bool offer_mesh(const Place& grain, const GrainSphere& sphere);
    /// The grain that a primitive is.
    uint32_t grain_of(const RTCHit& hit) const
    {
        const bool is_mesh = hit.geomID == Tracer::Impl::mesh_id;
        if (sized) return sized->grains[hit.primID + (is_mesh ? sized->spheres : 0)];
        return hit.primID + (is_mesh ? tracer->world.grains.analytic_count : 0);
    }
    /// Whether a mesh grain's sphere, met at Embree's hit, is to be offered: entered there, or left there with o
    /// inside.
    bool is_mesh_due(const GrainSphere& sphere, const RTCHit& hit) const;
};

/// The distance at which o + t d enters the sphere; false when it misses, or o is inside already.
bool enters_sphere(const GrainSphere& sphere, const V3d& o, const V3d& d, double& t);

/// Embree filter of every geometry, for nearest and for any hit: lets a candidate through only when it is really met.
void tracer_filter(const RTCFilterFunctionNArguments* args);

} // namespace scree
