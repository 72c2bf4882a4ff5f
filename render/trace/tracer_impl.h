#pragma once

// Private to the tracer: this header includes Embree.

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
    // Geometry ids in `scene`; from first_surface on follow the surfaces, then the lights, one geometry each.
    static constexpr uint32_t analytic_id = 0, mesh_id = 1, first_surface = 2;

    std::shared_ptr<const EmbreeDevice> device;
    const World& world;
    RTCScene scene = nullptr; // everything
    RTCScene open_scene = nullptr; // everything but grains, if a medium replaces some; else null
    RTCScene surface_scene = nullptr; // surfaces only, for rays inside grains; null if no ray can be inside a grain
    uint32_t first_light = first_surface;
    std::vector<uint32_t> light_of_id; // geometry id - first_light -> light
    double largest_radius = 0; // largest radius of a grain; set only if a medium replaces some
    // largest diameter of a mesh grain: a sphere that contains a ray's start ends within this distance
    double mesh_reach = 0;
    double radius = 0;
    std::unique_ptr<const RegionTracer> regions; // null if there are no media
    // if grain sizes differ too much for one scene; then `scene` has no grains
    std::unique_ptr<const SizeClasses> sizes;
    std::unique_ptr<const FillTracer>
        fill; // if the grains are those of a fill; then `scene` has only surfaces and lights

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

/// The data that a ray carries through Embree to the filters, and the nearest hit that they have accepted.
struct TracerQuery {
    RTCIntersectContext context; // first: Embree hands it back
    const Tracer::Impl* tracer;
    const SizeClass* sized = nullptr; // the class whose scene is traversed; null: the tracer's own scene
    V3d o, d;
    double advanced = 0; // Embree's ray starts at o + advanced d
    double reach = 0; // least length of Embree's ray, so that every sphere that contains its start is proposed
    Place from;
    uint32_t target = no_light; // a light that is ignored
    bool proxies = false; // grains are represented by their bounding spheres
    // proxies attenuate light (see `passed`); one counts as a hit only if no light is left behind it
    bool attenuates = false;
    const V3d* around = nullptr; // if set, only spheres that contain this point count
    double passed = 1; // part of the light that the proxies so far let through: the product of their alpha0
    double beyond = 0; // proxies entered at t up to this distance are ignored
    // distance of the nearest hit from o; nothing farther is accepted
    double best = std::numeric_limits<double>::infinity();
    Place place; // of the nearest hit
    float u = 0, v = 0; // barycentric coordinates on its triangle

    TracerQuery(const Tracer::Impl& impl, const V3d& o_, const V3d& d_, const Place& from_)
        : tracer(&impl), o(o_), d(d_), from(from_)
    {
        rtcInitIntersectContext(&context);
    }

    /// Where Embree's ray may end.
    float embree_end() const { return static_cast<float>(std::max(best - advanced, reach)); }
    /// Accepts a hit at t if it is nearer than `best`; returns whether it did.
    bool offer(const Place& what, double t);
    /// Whether a grain is represented by its bounding sphere.
    bool is_proxy(uint64_t grain) const
    {
        return proxies && !(from.kind == HitKind::grain && from.index == grain && from.triangle != no_triangle);
    }
    /// Accepts a sphere that is entered at t, if t is nearer than `best`. A sphere that only attenuates is not
    /// accepted.
    bool offer_sphere(const Place& grain, const GrainSphere& sphere, double t);
    /// Traces the mesh of a grain from o, which is outside it; accepts a hit nearer than `best`.
    bool offer_mesh(const Place& grain, const GrainSphere& sphere);
    /// The grain of Embree's primitive.
    uint32_t grain_of(const RTCHit& hit) const
    {
        const bool is_mesh = hit.geomID == Tracer::Impl::mesh_id;
        if (sized) return sized->grains[hit.primID + (is_mesh ? sized->spheres : 0)];
        return hit.primID + (is_mesh ? tracer->world.grains.analytic_count : 0);
    }
    /// Whether a mesh grain must be tested at Embree's hit of its sphere: the ray enters the sphere there, or leaves it
    /// and o is inside.
    bool is_mesh_due(const GrainSphere& sphere, const RTCHit& hit) const;
};

/// The distance at which o + t d enters the sphere; false when it misses, or o is inside already.
bool enters_sphere(const GrainSphere& sphere, const V3d& o, const V3d& d, double& t);

/// Embree's filter for every geometry, for nearest and for any hit: accepts a candidate only if the exact ray hits it.
void tracer_filter(const RTCFilterFunctionNArguments* args);

} // namespace scree
