#include "render/embree/embree_ray.h"
#include "render/embree/triangle.h"
#include "render/trace/tracer_impl.h"

#include <cmath>

namespace scree {

bool enters_sphere(const GrainSphere& sphere, const V3d& o, const V3d& d, double& t)
{
    const V3d to = sphere.centre - o;
    const double along = to.dot(d);
    const double disc = sphere.radius * sphere.radius - (to - along * d).length2();
    if (!(disc > 0)) return false;
    t = along - std::sqrt(disc);
    return t > 0;
}

namespace {

/// A ray in a grain's own frame, in units of its radius.
struct LocalRay {
    Imath::M33d to_world;
    V3d centre, o, d;
    double radius;
    double rounding; // error of o: a few 2^-53 of the numbers from which it was computed

    LocalRay(const World& world, const Place& grain, const GrainSphere& sphere, const V3d& world_o, const V3d& world_d)
        : to_world(world.rotation(grain.index)), centre(sphere.centre), radius(sphere.radius)
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

/// Where Embree's ray starts: o, moved away from the surface triangle on which it lies by the largest rounding error of
/// float.
V3d float_start(const World& world, const V3d& o, const V3d& d, const Place& from)
{
    if (from.kind != HitKind::surface) return o;
    const V3d n = unit_normal(corners(world.surfaces[from.index], from.triangle));
    const double bound = 0x1p-23 * (std::abs(n.x * o.x) + std::abs(n.y * o.y) + std::abs(n.z * o.z));
    return o + std::copysign(bound, n.dot(d)) * n;
}

/// The hit that a query found, with point and normal.
Hit make_hit(const TracerQuery& query)
{
    const World& world = query.tracer->world;
    const Place& place = query.place;
    Hit hit{place, query.best, query.o + query.best * query.d};
    switch (place.kind) {
    case HitKind::none:
    case HitKind::medium: break;
    case HitKind::grain: {
        const GrainSphere sphere = world.sphere(place.index);
        if (place.triangle == no_triangle) {
            hit.normal = (hit.point - sphere.centre).normalized();
            hit.point = sphere.centre + sphere.radius * hit.normal;
        } else {
            const LocalRay local(world, place, sphere, query.o, query.d);
            const Exemplar& exemplar = *world.types[place.type].exemplar;
            hit.point = local.world_point(exemplar.point({0, place.triangle, query.u, query.v}));
            hit.normal = exemplar.normal(place.triangle) * local.to_world;
        }
        break;
    }
    case HitKind::surface: {
        const auto c = corners(world.surfaces[place.index], place.triangle);
        const PlaneHit plane = meet_plane(c, query.o, query.d);
        const double u = std::clamp(plane.u, 0.0, 1.0), v = std::clamp(plane.v, 0.0, 1 - u);
        hit.point = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
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

bool TracerQuery::offer(const Place& what, double t)
{
    if (!(t < best)) return false;
    best = t;
    place = what;
    return true;
}

bool TracerQuery::offer_sphere(const Place& grain, const GrainSphere& sphere, double t)
{
    if (t <= beyond || (around && !((*around - sphere.centre).length2() < sphere.radius * sphere.radius))) return false;
    if (attenuates && t < best) {
        const V3d to = sphere.centre - o;
        const double along = to.dot(d);
        passed *=
            tracer->world.types[grain.type].gsdf->alpha0((to - along * d).length2() / (sphere.radius * sphere.radius));
        if (passed > 0) return false;
    }
    return offer(grain, t);
}

bool TracerQuery::offer_mesh(const Place& grain, const GrainSphere& sphere)
{
    const World& world = tracer->world;
    LocalRay local(world, grain, sphere, o, d);
    // Starts at the unit sphere, where a float is precise.
    double entry = 0;
    if (local.o.length2() > 1 && !enters_sphere({V3d(0), 1}, local.o, local.d, entry)) return false;
    const double end = std::min(best / local.radius - entry, 2.5); // no chord of the unit sphere is longer than 2
    if (!(end > 0)) return false;
    const bool own = from.kind == HitKind::grain && from.index == grain.index;
    ExemplarHit hit;
    const Exemplar& exemplar = *world.types[grain.type].exemplar;
    if (!exemplar.intersect(local.o + entry * local.d, local.d, local.rounding, end, Facing::entering,
                            own ? from.triangle : no_triangle, hit)) {
        return false;
    }
    if (!offer({HitKind::grain, grain.index, hit.triangle, grain.type}, (entry + hit.t) * local.radius)) return false;
    u = hit.u;
    v = hit.v;
    return true;
}

bool TracerQuery::is_mesh_due(const GrainSphere& sphere, const RTCHit& hit) const
{
    if (hit.Ng_x * d.x + hit.Ng_y * d.y + hit.Ng_z * d.z < 0) return true;
    // Embree proposes the far face alone if the ray starts inside, or so close outside that float cannot tell.
    const double distance = (o - sphere.centre).length();
    return distance - sphere.radius <= 0x1p-20 * (distance + o.length());
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
    const bool is_grain = hit->geomID == Tracer::Impl::analytic_id || hit->geomID == Tracer::Impl::mesh_id;
    const uint32_t grain = is_grain ? query.grain_of(*hit) : 0;
    if (hit->geomID == Tracer::Impl::analytic_id || (hit->geomID == Tracer::Impl::mesh_id && query.is_proxy(grain))) {
        const bool far_face = hit->Ng_x * query.d.x + hit->Ng_y * query.d.y + hit->Ng_z * query.d.z > 0;
        // The far face follows the near one; one sphere must not attenuate light twice.
        const FloatMargin& margin = query.sized ? query.sized->margin : world.grains.margin;
        if (far_face && (margin.complete || query.attenuates)) return;
        // A ray that leaves a convex grain cannot hit it again.
        if (query.from.kind == HitKind::grain && query.from.index == grain) return;
        const GrainStore& grains = world.grains;
        const GrainSphere sphere{grains.centre(grain), grains.radius(grain)};
        if (!enters_sphere(sphere, query.o, query.d, t) || t >= query.best) return;
        if (!query.offer_sphere({HitKind::grain, grain, no_triangle, grains.type_codes[grain]}, sphere, t)) return;
        ray->tfar = query.embree_end();
        args->valid[0] = -1;
        return;
    } else if (hit->geomID == Tracer::Impl::mesh_id) {
        const GrainSphere sphere = world.sphere(grain);
        // The exemplar lies at or beyond the sphere's near face, so Embree's tfar must be moved out from there, but
        // never beyond the nearest known hit.
        if (!query.is_mesh_due(sphere, *hit)) return;
        if (!query.offer_mesh({HitKind::grain, grain, no_triangle, world.grains.type_codes[grain]}, sphere)) return;
        ray->tfar = query.embree_end();
        args->valid[0] = -1;
        return;
    } else if (query.around) {
        return;
    } else if (tracer.is_surface(hit->geomID)) {
        place = {HitKind::surface, hit->geomID - Tracer::Impl::first_surface, hit->primID};
        if (query.from.kind == HitKind::surface && query.from.index == place.index &&
            query.from.triangle == place.triangle)
            return;
        const auto c = corners(world.surfaces[place.index], place.triangle);
        // Computed anew: Embree's t depends on where its ray starts.
        t = meet_plane(c, query.o, query.d).t;
        if (!std::isfinite(t)) return;
        // Within the rounding error of the start, a neighbour of the triangle that the ray leaves may seem to be hit.
        const double rounding = 0x1p-20 * (query.o.length() + c[0].length());
        const double nearer = std::min<double>(t, ray->tfar + query.advanced);
        if ((query.from.kind != HitKind::none || t < 0) && nearer <= rounding &&
            !meets_triangle(c, query.o, query.d, 0x1p-28 * rounding))
            return;
    } else {
        place = {HitKind::light, tracer.light_of(hit->geomID)};
        if (place.index == query.target) return;
        const Light& light = world.lights.lights()[place.index];
        if (light.kind == LightKind::sphere) {
            if (!enters_sphere({light.center, light.radius}, query.o, query.d, t)) return;
        } else {
            t = (light.corner - query.o).dot(light.normal) / query.d.dot(light.normal);
            if (!(t > 0)) return;
        }
    }
    if (!query.offer(place, t)) return;
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
Hit Tracer::grain_around(const V3d& place, const V3d& d) const
{
    const double back = 2 * impl_->largest_radius * (1 + 0x1p-10);
    TracerQuery query(*impl_, place - back * d, d, {HitKind::grain, std::numeric_limits<uint64_t>::max()});
    query.around = &place;
    query.proxies = true;
    query.best = back;
    query.advanced = -impl_->step_back();
    RTCRayHit ray = make_ray(query.o + query.advanced * d, d, query.embree_end());
    rtcOccluded1(impl_->scene, &query.context, &ray.ray);
    if (impl_->sizes && query.place.kind == HitKind::none) impl_->sizes->find_any(query);
    if (impl_->fill && query.place.kind == HitKind::none) impl_->fill->find_any(query);
    if (query.place.kind != HitKind::grain) return {};
    Hit hit = make_hit(query);
    hit.t -= back;
    return hit;
}

const RegionTracer* Tracer::regions() const { return impl_->regions.get(); }
double Tracer::scene_radius() const { return impl_->radius; }

namespace {

/// Moves the start of a distant ray to the scene's sphere, where a float is precise, and back by the step that widened
/// spheres need; false when the ray misses the sphere.
bool approach(const Tracer::Impl& tracer, TracerQuery& query)
{
    const double radius = tracer.radius;
    query.reach = tracer.mesh_reach;
    query.advanced = query.beyond - tracer.step_back();
    if (query.beyond > 0) return true;
    if (query.o.length2() <= 4 * radius * radius) return true;
    query.reach = 0; // a start this far out is in no sphere
    double t = 0;
    if (!enters_sphere({V3d(0), radius * (1 + 0x1p-10)}, query.o, query.d, t)) return false;
    query.advanced += t;
    return true;
}

} // namespace

Hit Tracer::intersect(const V3d& o, const V3d& d, const Place& from, GrainDetail detail, double beyond) const
{
    TracerQuery query(*impl_, o, d, from);
    query.proxies = detail == GrainDetail::proxy;
    query.beyond = beyond;
    if (!approach(*impl_, query)) return {};
    const V3d start = float_start(impl_->world, o, d, from) + query.advanced * d;
    RTCRayHit ray = make_ray(start, d, query.embree_end());
    rtcIntersect1(impl_->scene_with(detail), &query.context, &ray);
    if (impl_->sizes && detail != GrainDetail::none) impl_->sizes->find_nearest(query);
    if (impl_->fill && detail != GrainDetail::none) impl_->fill->find_nearest(query);
    return make_hit(query);
}

Hit Tracer::intersect_inside(const Place& grain, const V3d& o, const V3d& d, const Place& from) const
{
    const World& world = impl_->world;
    TracerQuery query(*impl_, o, d, from);
    const bool on_it = from.kind == HitKind::grain && from.index == grain.index;
    const GrainSphere sphere = world.sphere(grain.index);
    if (const auto& exemplar = world.types[grain.type].exemplar) {
        const LocalRay local(world, grain, sphere, o, d);
        ExemplarHit hit;
        if (exemplar->intersect(local.o, local.d, local.rounding, 2.5, Facing::leaving,
                                on_it ? from.triangle : no_triangle, hit)) {
            query.best = hit.t * local.radius;
            query.place = {HitKind::grain, grain.index, hit.triangle, grain.type};
            query.u = hit.u;
            query.v = hit.v;
        } else {
            return {};
        }
    } else {
        const V3d to = sphere.centre - o;
        const double along = to.dot(d), r = sphere.radius;
        // From a point on the sphere the chord is 2 `along`, so that nothing cancels.
        query.best = on_it ? 2 * along : along + std::sqrt(std::max(0.0, r * r - (to - along * d).length2()));
        query.place = {HitKind::grain, grain.index, no_triangle, grain.type};
    }
    if (impl_->surface_scene) {
        RTCRayHit ray = make_ray(float_start(world, o, d, from), d, query.best);
        rtcIntersect1(impl_->surface_scene, &query.context, &ray);
    }
    return make_hit(query);
}

double Tracer::visibility(const V3d& o, const V3d& d, double tmax, const Place& from, uint32_t target,
                          GrainDetail detail) const
{
    TracerQuery query(*impl_, o, d, from);
    query.best = tmax;
    query.target = target;
    query.proxies = query.attenuates = detail == GrainDetail::proxy;
    if (!approach(*impl_, query)) return 1;
    if (tmax <= query.advanced) return 1;
    RTCRayHit ray = make_ray(float_start(impl_->world, o, d, from) + query.advanced * d, d, query.embree_end());
    rtcOccluded1(impl_->scene_with(detail), &query.context, &ray.ray);
    if (impl_->sizes && detail != GrainDetail::none && query.place.kind == HitKind::none) impl_->sizes->find_any(query);
    if (impl_->fill && detail != GrainDetail::none && query.place.kind == HitKind::none) impl_->fill->find_any(query);
    return query.place.kind == HitKind::none ? query.passed : 0;
}

Hit Tracer::surface_between(const V3d& a, const V3d& b) const
{
    if (!impl_->surface_scene) return {};
    const V3d way = b - a;
    const double length = way.length();
    TracerQuery query(*impl_, a, way / length, {});
    query.best = length;
    RTCRayHit ray = make_ray(a, query.d, length);
    rtcIntersect1(impl_->surface_scene, &query.context, &ray);
    return make_hit(query);
}

} // namespace scree
