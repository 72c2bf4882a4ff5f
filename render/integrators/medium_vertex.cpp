// Volumetric path tracing: a path in media, and its scattering there.

#include "base/warp.h"
#include "render/integrators/path.h"
#include "render/stf/medium_shells.h"

#include <bit>

namespace scree {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Calls visit with the number of every region of a set.
template <class Visit>
void for_each_region(RegionSet set, const Visit& visit)
{
    for (; set != 0; set &= set - 1) visit(static_cast<uint32_t>(std::countr_zero(set)));
}

} // namespace

void Path::enter_world()
{
    media_.regions = region_tracer_->inside(ray_.o, ray_.d);
    for (const MediumRegion& region : world_.regions) {
        if (region.is_achromatic()) continue;
        media_.is_spectral = true;
        media_.spectral.hero = std::min(static_cast<uint32_t>(3 * sampler_.next()), 2u);
        break;
    }
}

double Path::clear()
{
    if (ray_.clear >= 0) return ray_.clear;
    // If the clearance is below a mean free path, a ray costs as much as the query, and no shell fits.
    double least = 0;
    if (const MediumRegion* const region = only_region()) {
        if (region->shells)
            least = region->shells->least_length();
        else if (const HomogeneousMedium* const uniform = region->medium->uniform())
            least = 1 / uniform->largest_sigma_t();
    }
    return ray_.clear = region_tracer_->clearance(ray_.o, least);
}

MediumEvent Path::medium_event(double t0, double t1)
{
    // Overlapping media add up: the nearest of their events counts. A medium whose sigma_t depends on the channel comes
    // last, so that its walk can end at the nearest event of the others.
    MediumEvent first;
    for (const bool achromatic : {true, false}) {
        for_each_region(media_.regions, [&](uint32_t number) {
            const MediumRegion& region = world_.regions[number];
            if (region.is_achromatic() != achromatic) return;
            const MediumEvent event =
                region.medium->event(ray_.o, ray_.d, t0, first.scattered ? first.t : t1, media_.spectral, sampler_);
            if (event.scattered) first = event;
        });
        if (!media_.is_spectral) break;
    }
    return first;
}

Color Path::media_transmittance(RegionSet regions, const V3d& o, const V3d& d, double t0, double t1)
{
    Color passed(1);
    for_each_region(regions, [&](uint32_t region) {
        passed *= world_.regions[region].medium->transmittance(o, d, t0, t1, sampler_);
    });
    return passed;
}

bool Path::step_through_media(Hit& met)
{
    if (const std::optional<bool> alive = step_through_shell(met)) return *alive;
    if (media_.regions != 0) { // within the clear radius the ray can only meet the medium
        if (const double until = clear(); until > ray_.passed) {
            if (const MediumEvent event = medium_event(ray_.passed, until); event.scattered)
                return handle_medium(event, met);
            ray_.passed = until;
        }
    }
    ++result_.segments;
    Crossing crossing;
    Sight sight;
    const auto distance = [&] {
        sight = look();
        return sight.hit.place.kind == HitKind::none ? infinite : sight.hit.t;
    };
    // Outside media, geometry mostly ends the ray before it reaches a medium.
    const bool outside = media_.regions == 0;
    double next = outside ? distance() : infinite;
    const bool crosses = region_tracer_->next(ray_.o, ray_.d, ray_.passed, next,
                                              ray_.crossed ? &*ray_.crossed : nullptr, media_.regions, crossing);
    if (!outside && media_.regions == 0) ++result_.leaks; // the ray slipped through the surface of a medium
    if (!outside || media_.regions != 0) next = distance();
    if (media_.regions != 0) {
        if (const MediumEvent event = medium_event(ray_.passed, std::min(crossing.t, next)); event.scattered)
            return handle_medium(event, met);
    }
    if (crosses && crossing.t <= next) {
        met.place.kind = HitKind::medium;
        met.place.index = crossing.region;
        met.t = crossing.t;
        met.point = ray_.o + crossing.t * ray_.d;
        handle_crossing(crossing);
        return true;
    }
    met = sight.hit;
    return handle(sight);
}

void Path::handle_crossing(const Crossing& crossing)
{
    const bool among_grains = detail(media_.regions) != GrainDetail::none;
    media_.regions = RegionTracer::after(media_.regions, crossing);
    ray_.crossed = crossing;
    ray_.passed = crossing.t;
    if (among_grains || detail(media_.regions) == GrainDetail::none) return;
    // The ray comes back among grains, which were not traced so far: it starts again in the void between them.
    attenuate(surrounding_, crossing.t);
    moved_ += crossing.t;
    start_ray(void_point(ray_.o + crossing.t * ray_.d, ray_.d, crossing), ray_.d, {});
    ray_.crossed = crossing; // the start may still lie on this triangle
    last_.elsewhere = true;
}

V3d Path::void_point(const V3d& place, const V3d& d, const Crossing& crossing)
{
    constexpr int tries = 32; // each succeeds with the void's share of the volume as probability
    constexpr double reach = 3;
    V3d point = place;
    Hit around = tracer_.grain_around(point, d);
    if (around.place.kind == HitKind::none) return point;
    const Frame frame(region_tracer_->normal(crossing));
    const double radius = reach * world_.sphere(around.place.index).radius;
    for (int i = 0; i < tries; ++i) {
        const double u = sampler_.next(), v = sampler_.next();
        const V2d offset = radius * sample_disk(u, v);
        point = place + offset.x * frame.s + offset.y * frame.t;
        if (tracer_.surface_between(place, point).place.kind != HitKind::none) continue;
        if (tracer_.grain_around(point, d).place.kind == HitKind::none) return point;
    }
    return place;
}

bool Path::handle_medium(const MediumEvent& event, Hit& met)
{
    met.place.kind = HitKind::medium;
    met.t = event.t;
    met.point = ray_.o + event.t * ray_.d;
    ++result_.events;
    if (is_cut()) return false;
    if (!result_.first.hit && depth_ == 1) {
        result_.first.hit = true;
        result_.first.albedo = event.albedo;
        result_.first.depth = moved_ + event.t;
    }
    attenuate(surrounding_, event.t);
    weight_ *= event.albedo;
    if (!survives()) return false;
    ray_.o = met.point;
    ray_.clear = -1;
    if (samples_lights()) {
        // Deep in a medium, lights are sampled only with the probability that light reaches this point unscattered.
        double reached = 1;
        const MediumRegion* const region = only_region();
        const HomogeneousMedium* const uniform = region ? region->medium->uniform() : nullptr;
        if (uniform && uniform->is_achromatic()) reached = std::exp(-uniform->sigma_t().x * clear());
        if (reached >= 1 || sampler_.next() < reached)
            add_phase_light(ray_.o, ray_.d, event.phase, Color(static_cast<Real>(1 / reached)));
    }

    const double u = sampler_.next(), v = sampler_.next(), cosine = event.phase.sample(u);
    last_ = {false, event.phase.pdf(cosine), ray_.o};
    start_ray(ray_.o, turned(ray_.d, cosine, v), {}, ray_.clear);
    return true;
}

Color Path::passing(const V3d& o, const V3d& d, double distance, const Place& from, uint32_t light, RegionSet regions)
{
    if (region_tracer_) return passing_media(o, d, distance, from, light, regions);
    ++result_.shadow_rays;
    return Color(static_cast<Real>(tracer_.visibility(o, d, distance, from, light, detail())));
}

Color Path::passing_media(V3d o, const V3d& d, double distance, Place from, uint32_t light, RegionSet regions)
{
    constexpr Real enough = 0.05f; // below, Russian roulette decides whether to continue
    Color passed(1);
    const auto is_lost = [&] {
        const Real most = max_component(passed);
        if (most >= enough) return false;
        if (!(most > 0) || sampler_.next() * enough >= most) return true;
        passed *= enough / most;
        return false;
    };
    Crossing crossing, last;
    bool crossed = false;
    double t = 0, looked = 0; // distances up to which media (t) and geometry (looked) have been handled
    for (;;) {
        const bool crosses = region_tracer_->next(o, d, t, distance, crossed ? &last : nullptr, regions, crossing);
        const double end = crosses ? crossing.t : distance;
        if (regions != 0) {
            passed *= media_transmittance(regions, o, d, t, end);
            if (is_lost()) return Color(0);
        }
        const GrainDetail grains = detail(regions);
        if (crosses) regions = RegionTracer::after(regions, crossing);
        // One shadow ray as far as the GrainDetail stays the same, so that geometry that coincides with a medium's
        // surface is not missed.
        if (!crosses || detail(regions) != grains) {
            ++result_.shadow_rays;
            const double visibility =
                tracer_.visibility(o + looked * d, d, end - looked, looked > 0 ? Place{} : from, light, grains);
            if (visibility == 0) return Color(0);
            passed *= static_cast<Real>(visibility);
            looked = end;
        }
        if (!crosses) return passed;
        t = crossing.t;
        last = crossing;
        crossed = true;
        if (grains == GrainDetail::none && detail(regions) != GrainDetail::none) { // as in handle_crossing
            o = void_point(o + t * d, d, crossing);
            distance = distance == infinite ? infinite : world_.lights.meet(light, o, d);
            if (!(distance > 0) || (world_.lights.lights()[light].is_infinite() != (distance == infinite)))
                return Color(0);
            t = looked = 0;
            from = {};
        }
    }
}

} // namespace scree
