#include "render/grains/triangle.h"
#include "render/scene/embree_ray.h"
#include "render/scene/tracer_impl.h"

#include <cmath>

namespace scree {

namespace {

/// The distance at which o + t d enters the sphere; false when it misses, or o is inside already.
bool enters_sphere(const V3d& centre, double radius, const V3d& o, const V3d& d, double& t)
{
    const V3d to = centre - o;
    const double along = to.dot(d);
    const double disc = radius * radius - (to - along * d).length2();
    if (!(disc > 0)) return false;
    t = along - std::sqrt(disc);
    return t > 0;
}

/// A ray in a grain's own frame, in units of its radius.
struct LocalRay {
    Imath::M33d to_world;
    V3d centre, o, d;
    double radius;
    double rounding; // of o: a few of 2^-53 of what it was computed from

    LocalRay(const GrainStore& grains, uint32_t grain, const V3d& world_o, const V3d& world_d)
        : to_world(grains.rotation(grain)), centre(grains.centre(grain)), radius(grains.radius(grain))
    {
        const Imath::M33d to_grain = to_world.transposed();
        o = (world_o - centre) * to_grain / radius;
        d = (world_d * to_grain).normalized();
        rounding = 0x1p-49 * ((world_o.length() + centre.length()) / radius + 1);
    }
    V3d world_point(const V3d& p) const { return centre + (p * to_world) * radius; }
};

std::array<V3d, 3> corners(const Surface& surface, uint32_t triangle)
{
    const auto& t = surface.triangles[triangle];
    return {V3d(surface.positions[t[0]]), V3d(surface.positions[t[1]]), V3d(surface.positions[t[2]])};
}

/// Where Embree's ray starts: near o, but off the surface triangle it lies on by what rounding to float may move it.
V3d float_start(const World& world, const V3d& o, const V3d& d, const Place& from)
{
    if (from.kind != HitKind::surface) return o;
    const V3d n = unit_normal(corners(world.surfaces[from.index], from.triangle));
    const double bound = 0x1p-23 * (std::abs(n.x * o.x) + std::abs(n.y * o.y) + std::abs(n.z * o.z));
    return o + std::copysign(bound, n.dot(d)) * n;
}

/// Fills in point and normal of what a query found.
Hit make_hit(const TracerQuery& query)
{
    const World& world = query.tracer->world;
    const Place& place = query.place;
    Hit hit{place, query.best, query.o + query.best * query.d};
    switch (place.kind) {
    case HitKind::none: break;
    case HitKind::grain: {
        const V3d centre = world.grains.centre(place.index);
        if (place.triangle == no_triangle) {
            hit.normal = (hit.point - centre).normalized();
            hit.point = centre + world.grains.radius(place.index) * hit.normal;
        } else {
            const LocalRay local(world.grains, place.index, query.o, query.d);
            const Exemplar& exemplar = *world.types[world.grains.type_codes[place.index]].exemplar;
            hit.point = local.world_point(exemplar.point({0, place.triangle, query.u, query.v}));
            hit.normal = exemplar.normal(place.triangle) * local.to_world;
        }
        break;
    }
    case HitKind::surface: {
        const auto c = corners(world.surfaces[place.index], place.triangle);
        hit.point = c[0] + static_cast<double>(query.u) * (c[1] - c[0]) + static_cast<double>(query.v) * (c[2] - c[0]);
        hit.normal = unit_normal(c);
        hit.t = (hit.point - query.o).dot(query.d);
        break;
    }
    case HitKind::light: {
        const Light& light = world.lights.lights()[place.index];
        hit.normal = light.kind == LightKind::rectangle ? light.normal : (hit.point - light.center).normalized();
        break;
    }
    }
    return hit;
}

} // namespace

bool TracerQuery::offer_mesh(uint32_t grain)
{
    const World& world = tracer->world;
    LocalRay local(world.grains, grain, o, d);
    // Start at the unit sphere, where a float is precise.
    double entry = 0;
    if (local.o.length2() > 1 && !enters_sphere(V3d(0), 1, local.o, local.d, entry)) return false;
    const double end = std::min(best / local.radius - entry, 2.5); // no chord of the unit sphere is longer than 2
    if (!(end > 0)) return false;
    const bool own = from.kind == HitKind::grain && from.index == grain;
    ExemplarHit hit;
    const Exemplar& exemplar = *world.types[world.grains.type_codes[grain]].exemplar;
    if (!exemplar.intersect(local.o + entry * local.d, local.d, local.rounding, end, Facing::entering, own ? from.triangle : no_triangle, hit)) {
        return false;
    }
    const double t = (entry + hit.t) * local.radius;
    if (!(t < best)) return false;
    best = t;
    place = {HitKind::grain, grain, hit.triangle};
    u = hit.u;
    v = hit.v;
    return true;
}

bool TracerQuery::is_mesh_due(uint32_t grain, const RTCHit& hit) const
{
    const V3d centre = tracer->world.grains.centre(grain);
    const double radius = tracer->world.grains.radius(grain);
    if (hit.Ng_x * d.x + hit.Ng_y * d.y + hit.Ng_z * d.z < 0) return true;
    // The far face is proposed alone when the ray starts inside, or so near outside that float does not tell.
    const double distance = (o - centre).length();
    return distance - radius <= 0x1p-20 * (distance + o.length());
}

void tracer_filter(const RTCFilterFunctionNArguments* args)
{
    // rtcIntersect1 and rtcOccluded1 only: N is 1.
    auto& query = *reinterpret_cast<TracerQuery*>(args->context);
    auto* ray = reinterpret_cast<RTCRay*>(args->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
    const Tracer::Impl& tracer = *query.tracer;
    const World& world = tracer.world;
    args->valid[0] = 0;

    Place place;
    double t;
    if (hit->geomID == Tracer::Impl::analytic_id) {
        place = {HitKind::grain, hit->primID};
        // A convex grain is not met again by the ray that leaves it.
        if (query.from.kind == HitKind::grain && query.from.index == place.index) return;
        if (!enters_sphere(world.grains.centre(place.index), world.grains.radius(place.index), query.o, query.d, t)) return;
    } else if (hit->geomID == Tracer::Impl::mesh_id) {
        const uint32_t grain = hit->primID + world.grains.analytic_count;
        // The exemplar lies at or beyond the sphere's near face: the ray's end moves out from there, but never beyond the
        // nearest hit known.
        if (!query.is_mesh_due(grain, *hit) || !query.offer_mesh(grain)) return;
        ray->tfar = query.embree_end();
        args->valid[0] = -1;
        return;
    } else if (tracer.is_surface(hit->geomID)) {
        place = {HitKind::surface, hit->geomID - Tracer::Impl::first_surface, hit->primID};
        if (query.from.kind == HitKind::surface && query.from.index == place.index && query.from.triangle == place.triangle) return;
        const auto c = corners(world.surfaces[place.index], place.triangle);
        t = ray->tfar + query.advanced;
        // Within what rounding to float may have moved the start, a neighbour of what the ray leaves may seem to be met.
        const double rounding = 0x1p-20 * (query.o.length() + c[0].length());
        if (query.from.kind != HitKind::none && t <= rounding && !meets_triangle(c, query.o, query.d, 0x1p-28 * rounding)) return;
    } else {
        place = {HitKind::light, tracer.light_of(hit->geomID)};
        if (place.index == query.target) return;
        const Light& light = world.lights.lights()[place.index];
        if (light.kind == LightKind::sphere) {
            if (!enters_sphere(light.center, light.radius, query.o, query.d, t)) return;
        } else {
            t = (light.corner - query.o).dot(light.normal) / query.d.dot(light.normal);
            if (!(t > 0)) return;
        }
    }
    if (!(t < query.best)) return;
    query.best = t;
    query.place = place;
    query.u = hit->u;
    query.v = hit->v;
    ray->tfar = query.embree_end();
    args->valid[0] = -1;
}

Tracer::Tracer(std::shared_ptr<const EmbreeDevice> device, const World& world)
    : impl_(std::make_unique<Impl>(std::move(device), world))
{
}

Tracer::~Tracer() = default;

RTCSceneTy* Tracer::embree_scene() const { return impl_->scene; }
double Tracer::scene_radius() const { return impl_->radius; }

namespace {

/// Moves the start of a ray from far away to near the scene's sphere, where a float is precise; false when it misses.
bool approach(const Tracer::Impl& tracer, TracerQuery& query)
{
    const double radius = tracer.radius;
    query.reach = tracer.mesh_reach;
    if (query.o.length2() <= 4 * radius * radius) return true;
    query.reach = 0; // no sphere is around a start this far out
    double t = 0;
    if (!enters_sphere(V3d(0), radius * (1 + 0x1p-10), query.o, query.d, t)) return false;
    query.advanced = t;
    return true;
}

} // namespace

Hit Tracer::intersect(const V3d& o, const V3d& d, const Place& from) const
{
    TracerQuery query(*impl_, o, d, from);
    if (!approach(*impl_, query)) return {};
    const V3d start = float_start(impl_->world, o, d, from) + query.advanced * d;
    RTCRayHit ray = make_ray(start, d, query.embree_end());
    rtcIntersect1(impl_->scene, &query.context, &ray);
    return make_hit(query);
}

Hit Tracer::intersect_inside(uint32_t grain, const V3d& o, const V3d& d, const Place& from) const
{
    const World& world = impl_->world;
    TracerQuery query(*impl_, o, d, from);
    const bool on_it = from.kind == HitKind::grain && from.index == grain;
    if (const auto& exemplar = world.types[world.grains.type_codes[grain]].exemplar) {
        const LocalRay local(world.grains, grain, o, d);
        ExemplarHit hit;
        if (exemplar->intersect(local.o, local.d, local.rounding, 2.5, Facing::leaving, on_it ? from.triangle : no_triangle, hit)) {
            query.best = hit.t * local.radius;
            query.place = {HitKind::grain, grain, hit.triangle};
            query.u = hit.u;
            query.v = hit.v;
        } else {
            return {};
        }
    } else {
        const V3d to = world.grains.centre(grain) - o;
        const double along = to.dot(d), r = world.grains.radius(grain);
        // From a point on the sphere the chord is 2 along, without cancellation.
        query.best = on_it ? 2 * along : along + std::sqrt(std::max(0.0, r * r - (to - along * d).length2()));
        query.place = {HitKind::grain, grain};
    }
    if (impl_->surface_scene) {
        RTCRayHit ray = make_ray(float_start(world, o, d, from), d, query.best);
        rtcIntersect1(impl_->surface_scene, &query.context, &ray);
    }
    return make_hit(query);
}

bool Tracer::occluded(const V3d& o, const V3d& d, double tmax, const Place& from, uint32_t target) const
{
    TracerQuery query(*impl_, o, d, from);
    query.best = tmax;
    query.target = target;
    if (!approach(*impl_, query)) return false;
    if (tmax <= query.advanced) return false;
    RTCRayHit ray = make_ray(float_start(impl_->world, o, d, from) + query.advanced * d, d, query.embree_end());
    rtcOccluded1(impl_->scene, &query.context, &ray.ray);
    return query.place.kind != HitKind::none;
}

} // namespace scree
