// Proxy path tracing (Müller et al. 2016, algorithm 1): a grain's bounding sphere represents the grain averaged over
// rotations. A ray that misses the grain (probability alpha_g^0) continues, and can hit other geometry in the sphere.
// The paper moves the ray to the far side instead, in print by 2 (w_i . w_o) w_o, which should be the chord
// 2 (n_o . w_o) w_o.

#include "render/integrators/path.h"

namespace scree {

namespace {

/// Approximate length of a recorded path inside the bounding sphere but outside the grain.
double length_outside(const V3d& entry, const V3d& exit, const GsdfRecord& record, double radius)
{
    return std::max(0.0, (exit - entry).length() - record.length * radius);
}

} // namespace

bool Path::misses_proxy(const Hit& hit)
{
    const Gsdf& gsdf = *world_.types[hit.place.type].gsdf;
    return !gsdf.always_met() && sampler_.next() < gsdf.alpha0(Encounter(hit.normal, ray_.d).q);
}

bool Path::handle_proxy(const Hit& hit)
{
    const GrainSphere sphere = world_.sphere(hit.place.index);
    const GrainType& type = world_.types[hit.place.type];
    const Gsdf& gsdf = *type.gsdf;
    const Encounter encounter(hit.normal, ray_.d);

    if (is_cut()) return false;
    if (!result_.first.hit && depth_ == 1) note_first(hit, type.material);

    const uint32_t stratum = Gsdf::stratum(encounter.q, sampler_.next());
    if (samples_lights()) add_proxy_light(hit, encounter, stratum);

    const uint32_t cell = gsdf.sample_cell(stratum, sampler_.next());
    const uint32_t number = gsdf.pick(stratum, cell, sampler_.next());
    const GsdfRecord& record = gsdf.record(number);
    weight_ *= gsdf.weight(number, type.material, sphere.radius);
    if (!survives()) return false;
    const V3d exit = sphere.centre + sphere.radius * encounter.to_world(record.point.unpack());
    attenuate(surrounding_, length_outside(hit.point, exit, record, sphere.radius));
    if (const Hit between = tracer_.surface_between(hit.point, exit); between.place.kind == HitKind::surface) {
        // A surface cuts through the sphere: the path hits this surface first.
        ray_.d = (exit - hit.point).normalized();
        if (region_tracer_) media_.regions = region_tracer_->after(media_.regions, hit.point, between.point);
        last_ = {true, 0, hit.point};
        return handle_interface(between);
    }
    if (region_tracer_) media_.regions = region_tracer_->after(media_.regions, hit.point, exit);
    start_ray(exit, encounter.to_world(record.direction.unpack()).normalized(), hit.place);
    last_ = {false, gsdf.cell_density(stratum, cell), sphere.centre, true};
    return true;
}

void Path::add_proxy_light(const Hit& hit, const Encounter& encounter, uint32_t stratum)
{
    // Light is sampled from the sphere's centre; the shadow ray starts at the exit point of a record of that direction.
    // Rays from other exit points that hit the light although the centre does not see it in their direction are left to
    // scattering.
    const GrainSphere sphere = world_.sphere(hit.place.index);
    const GrainType& type = world_.types[hit.place.type];
    const Gsdf& gsdf = *type.gsdf;
    const double u0 = sampler_.next(), u1 = sampler_.next(), u2 = sampler_.next();
    const LightSample light = world_.lights.sample(sphere.centre, u0, u1, u2);
    if (!light.valid) return;
    const V3d w = encounter.to_local(light.direction);
    const double density = gsdf.density(stratum, w);
    if (!(density > 0)) return;
    const uint32_t cell = DirectionGrid::cell(DirectionGrid::angles(w));
    const uint32_t number = gsdf.pick(stratum, cell, sampler_.next());
    Weight kept = gsdf.weight(number, type.material, sphere.radius);
    if (is_black(kept)) return;
    const V3d exit = sphere.centre + sphere.radius * encounter.to_world(gsdf.record(number).point.unpack());
    double distance = light.distance;
    if (std::isfinite(distance)) {
        distance = world_.lights.meet(light.light, exit, light.direction);
        if (!std::isfinite(distance)) return;
    }
    if (surrounding_)
        kept *= transmittance(*surrounding_, length_outside(hit.point, exit, gsdf.record(number), sphere.radius));
    const RegionSet regions = region_tracer_ ? region_tracer_->after(media_.regions, hit.point, exit) : 0;
    const Color passed = passing(exit, light.direction, distance, hit.place, light.light, regions);
    if (is_black(passed) || tracer_.surface_between(hit.point, exit).place.kind == HitKind::surface) return;
    add_light_sample(light, distance, kept * density, gsdf.cell_density(stratum, cell), passed);
}

} // namespace scree
