#include "render/integrators/ept.h"

#include "render/materials/bsdf.h"

namespace scree {

namespace {

/// Power heuristic for two strategies of one sample each.
double mis_weight(double p, double other) { return p * p / (p * p + other * other); }

class EptPath {
public:
    EptPath(const World& world, const Tracer& tracer, Sampler& sampler, const EptOptions& options)
        : world_(world), tracer_(tracer), sampler_(sampler), options_(options)
    {
    }

    PathResult run(V3d o, V3d d, std::vector<PathVertex>* trail)
    {
        o_ = o;
        d_ = d;
        bool alive = true;
        while (alive) {
            const V3d start = o_, direction = d_;
            const bool inside = is_inside();
            const Hit hit = inside ? tracer_.intersect_inside(grain_, o_, d_, from_) : tracer_.intersect(o_, d_, from_);
            ++result_.segments;
            if (result_.segments % 65536 == 0 && options_.stop && options_.stop()) {
                result_.stopped = true;
                break;
            }
            alive = handle(hit);
            if (trail) trail->push_back({start, direction, hit, inside, weight_, result_.radiance});
        }
        return result_;
    }

private:
    bool is_inside() const { return grain_.kind == HitKind::grain; }

    /// One vertex; false when the path ends there.
    bool handle(const Hit& hit)
    {
        if (hit.place.kind == HitKind::none) {
            if (is_inside()) { // lost between two triangles: go on as if the interface were not there
                ++result_.leaks;
                grain_ = {};
                from_ = {};
                specular_ = true; // no light was sampled for this way
                return true;
            }
            add_infinite_lights();
            return false;
        }
        if (const Material* medium = is_inside() ? &material_of(grain_) : surrounding_) {
            weight_ *= transmittance(*medium, hit.t);
        }
        if (hit.place.kind == HitKind::light) {
            add_light(hit);
            return false;
        }
        if (options_.max_depth > 0 && depth_ >= options_.max_depth) {
            result_.cut = true;
            return false;
        }
        ++depth_;
        const bool on_grain = hit.place.kind == HitKind::grain;
        const Material& material = on_grain ? material_of(hit.place) : world_.surfaces[hit.place.index].material;
        const Frame frame(hit.normal);
        const V3d wo = frame.to_local(-d_);
        if (result_.segments == 1) note_first(hit, material);

        if (!material.is_delta() && world_.lights.any_sampled() && options_.direct_light != DirectLight::scattering_only) {
            add_direct_light(hit, material, frame, wo);
        }
        const BsdfSample sample = sample_bsdf(material, wo, sampler_);
        if (!sample.valid) return false;
        weight_ *= sample.weight;
        if (!survives()) return false;

        if (material.transmits()) {
            if (on_grain) grain_ = sample.wi.z < 0 ? hit.place : Place{};
            else surrounding_ = sample.wi.z < 0 ? &material : nullptr;
        }
        o_ = hit.point;
        d_ = frame.to_world(sample.wi).normalized();
        from_ = hit.place;
        specular_ = material.is_delta();
        scatter_pdf_ = sample.pdf;
        return true;
    }

    /// Russian roulette: kills with the weight's largest channel, and only what has lost some.
    bool survives()
    {
        const double w = max_component(weight_);
        if (w <= 0) return false;
        if (w >= 1 || depth_ < 3) return true;
        if (sampler_.next() >= w) return false;
        weight_ *= static_cast<float>(1 / w);
        return true;
    }

    static uint32_t light_of(const Hit& hit) { return static_cast<uint32_t>(hit.place.index); }
    const Material& material_of(const Place& grain) const { return world_.types[grain.type].material; }

    static C3f transmittance(const Material& medium, double length)
    {
        return is_black(medium.absorption) ? C3f(1) : exp(medium.absorption * static_cast<float>(-length));
    }

    void note_first(const Hit& hit, const Material& material)
    {
        FirstHit& first = result_.first;
        first.hit = true;
        first.albedo = material.kind == MaterialKind::lambert ? material.reflectance : material.tint;
        first.normal = V3f(hit.normal);
        first.depth = hit.t;
        if (hit.place.kind == HitKind::grain) {
            first.type = hit.place.type;
            first.id = world_.id(hit.place.index);
        }
    }

    void add_direct_light(const Hit& hit, const Material& material, const Frame& frame, const V3d& wo)
    {
        const double u0 = sampler_.next(), u1 = sampler_.next(), u2 = sampler_.next();
        const LightSample light = world_.lights.sample(hit.point, u0, u1, u2);
        if (!light.valid) return;
        const V3d wi = frame.to_local(light.direction);
        // What leads into a grain (or stays in it) is cut off by its own interface.
        const bool leads_inside = hit.place.kind == HitKind::grain ? material.transmits() && wi.z <= 0 : is_inside();
        if (leads_inside) return;
        const C3f f = eval_bsdf(material, wo, wi, sampler_);
        if (is_black(f)) return;
        ++result_.shadow_rays;
        if (tracer_.occluded(hit.point, light.direction, light.distance, hit.place, light.light)) return;
        double w = 1;
        if (!light.delta && options_.direct_light == DirectLight::both) w = mis_weight(light.pdf, pdf_bsdf(material, wo, wi));
        C3f arriving = light.radiance;
        if (surrounding_ && std::isfinite(light.distance)) arriving *= transmittance(*surrounding_, light.distance);
        result_.radiance += weight_ * f * arriving * static_cast<float>(w / light.pdf);
    }

    /// Weight of light that scattering found, against the chance that sampling the light had of it.
    double found_weight(double light_pdf) const
    {
        if (specular_ || light_pdf == 0) return 1;
        if (options_.direct_light == DirectLight::both) return mis_weight(scatter_pdf_, light_pdf);
        return options_.direct_light == DirectLight::lights_only ? 0 : 1;
    }

    void add_infinite_lights()
    {
        const auto& lights = world_.lights.lights();
        for (uint32_t i = 0; i < lights.size(); ++i) {
            if (!lights[i].is_infinite()) continue;
            const C3f radiance = world_.lights.infinite_radiance(i, d_);
            if (is_black(radiance)) continue;
            const double pdf = specular_ || !lights[i].is_sampled() ? 0 : world_.lights.pdf(i, o_, d_, 0);
            result_.radiance += weight_ * radiance * static_cast<float>(found_weight(pdf));
        }
    }

    void add_light(const Hit& hit)
    {
        const double pdf = specular_ ? 0 : world_.lights.pdf(light_of(hit), o_, d_, hit.t);
        result_.radiance += weight_ * world_.lights.emitted(light_of(hit)) * static_cast<float>(found_weight(pdf));
    }

    const World& world_;
    const Tracer& tracer_;
    Sampler& sampler_;
    const EptOptions& options_;

    V3d o_, d_;
    Place from_;
    Place grain_;              // that the path is inside of
    const Material* surrounding_ = nullptr; // of the dielectric surface the path is inside of, outside grains
    C3f weight_{1};
    bool specular_ = true;     // the last scattering (or the camera) could not have sampled lights
    double scatter_pdf_ = 0;
    uint32_t depth_ = 0;
    PathResult result_;
};

} // namespace

PathResult trace_ept(const World& world, const Tracer& tracer, V3d o, V3d d, Sampler& sampler, const EptOptions& options,
                     std::vector<PathVertex>* trail)
{
    return EptPath(world, tracer, sampler, options).run(o, d, trail);
}

} // namespace scree
