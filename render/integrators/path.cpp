#include "render/integrators/path.h"

#include "render/materials/bsdf.h"

#include <bit>

namespace scree {

PathResult Path::run(V3d o, V3d d, std::vector<PathVertex>* trail)
{
    start_ray(o, d, {});
    last_.seen_from = o;
    if (region_tracer_) enter_world();
    bool alive = true;
    while (alive) {
        const V3d start = ray_.o, direction = ray_.d;
        const bool inside = is_inside();
        if ((++steps_ & 0xffff) == 0 && options_.stop && options_.stop()) {
            result_.stopped = true;
            break;
        }
        Hit hit;
        if (region_tracer_ && !inside) {
            alive = step_through_media(hit);
        } else {
            const Sight sight =
                inside ? Sight{tracer_.intersect_inside(grains_.inside, ray_.o, ray_.d, ray_.from)} : look();
            ++result_.segments;
            hit = sight.hit;
            alive = handle(sight);
        }
        if (trail) trail->push_back({start, direction, hit, inside, weight_, light_});
    }
    result_.radiance = Color(light_);
    result_.last_direction = ray_.d;
    return result_;
}

Hit Path::as_proxy(const Hit& hit) const
{
    const GrainSphere sphere = world_.sphere(hit.place.index);
    const V3d to = sphere.centre - ray_.o;
    const double along = to.dot(ray_.d);
    Hit proxy = hit;
    proxy.place.triangle = no_triangle;
    proxy.t = along - safe_sqrt(sphere.radius * sphere.radius - (to - along * ray_.d).length2());
    proxy.point = ray_.o + proxy.t * ray_.d;
    proxy.normal = (proxy.point - sphere.centre).normalized();
    proxy.t = std::max(0.0, proxy.t); // the camera may be inside the sphere
    return proxy;
}

const MediumRegion* Path::only_region() const
{
    if (!std::has_single_bit(media_.regions)) return nullptr;
    return &world_.regions[static_cast<size_t>(std::countr_zero(media_.regions))];
}

Path::Sight Path::look()
{
    const Hit hit = tracer_.intersect(ray_.o, ray_.d, ray_.from, detail(media_.regions), ray_.beyond);
    if (depth_ == 0 && hit.place.kind == HitKind::grain && grains_.explicit_left > 0 && !is_resolved(hit))
        return {as_proxy(hit), true};
    return {hit, false};
}

bool Path::handle(const Sight& sight)
{
    const Hit& hit = sight.hit;
    if (sight.unresolved) grains_.explicit_left = 0;
    if (hit.place.kind == HitKind::none) return handle_miss();
    const bool is_proxy = hit.place.kind == HitKind::grain && hit.place.triangle == no_triangle && !is_inside() &&
                          detail() == GrainDetail::proxy;
    // The ray already hit the geometry of an unresolved grain, so its proxy counts as hit too.
    if (is_proxy && !sight.unresolved && misses_proxy(hit)) {
        ray_.beyond = ray_.passed = hit.t; // the same ray goes on
        return true;
    }
    if (region_tracer_ && is_inside() && hit.place.kind != HitKind::none)
        media_.regions = region_tracer_->after(media_.regions, ray_.o, hit.point);
    attenuate(is_inside() ? &material_of(grains_.inside) : surrounding_, hit.t);
    if (hit.place.kind == HitKind::light) {
        add_light(hit);
        return false;
    }
    return is_proxy ? handle_proxy(hit) : handle_interface(hit);
}

bool Path::handle_miss()
{
    if (is_inside()) { // the ray slipped between two triangles: the path goes on as if there were no interface
        ++result_.leaks;
        grains_.inside = {};
        start_ray(ray_.o, ray_.d, {});
        last_.specular = true; // no light was sampled for this ray
        return true;
    }
    add_infinite_lights();
    return false;
}

bool Path::is_cut()
{
    result_.cut = options_.max_depth > 0 && depth_ >= options_.max_depth;
    ++depth_;
    return result_.cut;
}

bool Path::handle_interface(const Hit& hit)
{
    if (is_cut()) return false;
    const bool on_grain = hit.place.kind == HitKind::grain;
    if (on_grain && hit.place.index != grains_.last) {
        grains_.last = hit.place.index;
        if (grains_.explicit_left != all_grains) --grains_.explicit_left;
    }
    const Material& material = on_grain ? material_of(hit.place) : world_.surfaces[hit.place.index].material;
    const Frame frame(hit.normal);
    const V3d wo = frame.to_local(-ray_.d);
    if (!result_.first.hit && depth_ == 1) note_first(hit, material);

    if (!material.is_delta() && samples_lights()) {
        add_direct_light(hit, material, frame, wo);
    }
    const BsdfSample sample = sample_bsdf(material, wo, sampler_);
    if (!sample.valid) return false;
    weight_ *= sample.weight;
    if (!survives()) return false;

    if (material.transmits()) {
        if (on_grain)
            grains_.inside = sample.wi.z < 0 ? hit.place : Place{};
        else
            surrounding_ = sample.wi.z < 0 ? &material : nullptr;
    }
    start_ray(hit.point, frame.to_world(sample.wi).normalized(), hit.place);
    last_ = {material.is_delta(), sample.pdf, ray_.o};
    return true;
}

bool Path::survives()
{
    const double w = max_component(weight_ * media_.spectral.weight());
    if (w <= 0) return false;
    constexpr double worth_ending =
        1 - 0x1p-5; // above, random numbers in steps of 2^-32 would be too coarse for very small absorption
    if (w >= worth_ending || depth_ < 3) return true;
    if (sampler_.next() >= w) return false;
    weight_ *= 1 / w;
    return true;
}

Weight Path::transmittance(const Material& medium, double length)
{
    return is_black(medium.absorption) ? Weight(1) : exp(Weight(medium.absorption) * -length);
}

void Path::note_first(const Hit& hit, const Material& material)
{
    FirstHit& first = result_.first;
    first.hit = true;
    first.albedo = material.kind == MaterialKind::lambert ? material.reflectance : material.tint;
    first.normal = V3f(hit.normal);
    first.depth = moved_ + hit.t;
    if (hit.place.kind == HitKind::grain) {
        first.type = hit.place.type;
        first.id = world_.id(hit.place.index);
    }
}

void Path::add_direct_light(const Hit& hit, const Material& material, const Frame& frame, const V3d& wo)
{
    const double u0 = sampler_.next(), u1 = sampler_.next(), u2 = sampler_.next();
    const LightSample light = world_.lights.sample(hit.point, u0, u1, u2);
    if (!light.valid) return;
    const V3d wi = frame.to_local(light.direction);
    // Light that goes into a grain (or stays in it) is blocked by the grain's own interface.
    const bool leads_inside = hit.place.kind == HitKind::grain ? material.transmits() && wi.z <= 0 : is_inside();
    if (leads_inside) return;
    const Color f = eval_bsdf(material, wo, wi, sampler_);
    if (is_black(f)) return;
    const Color passed = passing(hit.point, light.direction, light.distance, hit.place, light.light, media_.regions);
    if (!is_black(passed)) add_light_sample(light, light.distance, f, pdf_bsdf(material, wo, wi), passed);
}

void Path::add_light_sample(const LightSample& light, double distance, const Color& f, double scatter_pdf,
                            const Color& passed)
{
    double w = 1;
    if (!light.delta && options_.direct_light == DirectLight::both) w *= mis_weight(light.pdf, scatter_pdf);
    Color arriving = light.radiance * passed;
    if (surrounding_ && std::isfinite(distance)) arriving *= transmittance(*surrounding_, distance);
    add(f * arriving * static_cast<Real>(w / light.pdf));
}

double Path::found_weight(double light_pdf) const
{
    if (last_.specular || light_pdf == 0) return 1;
    if (options_.direct_light == DirectLight::both) return mis_weight(last_.pdf, light_pdf);
    return options_.direct_light == DirectLight::lights_only ? 0 : 1;
}

double Path::found_pdf(uint32_t light, double distance) const
{
    if (last_.specular || !world_.lights.lights()[light].is_sampled()) return 0;
    if (last_.elsewhere && std::isfinite(distance)) {
        distance = world_.lights.meet(light, last_.seen_from, ray_.d);
        if (!std::isfinite(distance)) return 0;
    }
    return world_.lights.pdf(light, last_.seen_from, ray_.d, distance);
}

void Path::add_infinite_lights()
{
    const auto& lights = world_.lights.lights();
    for (uint32_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].is_infinite()) continue;
        const Color radiance = world_.lights.infinite_radiance(i, ray_.d);
        if (is_black(radiance)) continue;
        add(radiance * static_cast<Real>(found_weight(found_pdf(i, std::numeric_limits<double>::infinity()))));
    }
}

void Path::add_light(const Hit& hit)
{
    const auto light = static_cast<uint32_t>(hit.place.index);
    const double pdf = found_pdf(light, hit.t);
    add(world_.lights.emitted(light) * static_cast<Real>(found_weight(pdf)));
}

PathResult trace_path(const World& world, const Tracer& tracer, V3d o, V3d d, Sampler& sampler,
                      const PathOptions& options, std::vector<PathVertex>* trail)
{
    return Path(world, tracer, sampler, options).run(o, d, trail);
}

} // namespace scree
