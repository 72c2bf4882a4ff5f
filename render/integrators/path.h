#pragma once

// Private to the integrators: one light path on its way, and what it does at each kind of vertex.

#include "render/gsdf/encounter.h"
#include "render/integrators/path_tracer.h"

#include <optional>

namespace scree {

struct FittingShell;

/// Power heuristic for two strategies of one sample each.
inline double mis_weight(double p, double other) { return p * p / (p * p + other * other); }

class Path {
public:
    Path(const World& world, const Tracer& tracer, Sampler& sampler, const PathOptions& options)
        : world_(world), tracer_(tracer), sampler_(sampler), options_(options), media_(tracer.regions()),
          explicit_left_(options.explicit_grains)
    {
    }

    PathResult run(V3d o, V3d d, std::vector<PathVertex>* trail);

private:
    /// What the last scattering knew of the light it may find: for the weight of what it finds indeed.
    struct Scattering {
        bool specular = true; ///< it (or the camera) could not have sampled lights
        double pdf = 0;
        V3d seen_from{0}; ///< where lights were sampled from
        bool elsewhere = false; ///< the path did not go on from there: lights are to be met again from seen_from
    };

    /// Whether a grain that the camera sees is wide enough to be shown as it is.
    bool is_resolved(const Hit& hit) const
    {
        const double pixel = options_.resolved.width + options_.resolved.slope * (moved_ + hit.t);
        return !(2 * world_.sphere(hit.place.index).radius < pixel);
    }
    bool is_inside() const { return grain_.kind == HitKind::grain; }
    GrainDetail detail() const { return explicit_left_ > 0 ? GrainDetail::as_is : GrainDetail::proxy; }
    /// The same within the regions: there may be a medium in place of the grains.
    GrainDetail detail(RegionSet regions) const
    {
        return media_ && (regions & media_->instead_of_grains()) != 0 ? GrainDetail::none : detail();
    }
    const Material& material_of(const Place& grain) const { return world_.types[grain.type].material; }
    static Weight transmittance(const Material& medium, double length);
    void attenuate(const Material* medium, double length)
    {
        if (medium) weight_ *= transmittance(*medium, length);
    }

    // On the ray through media (medium_vertex.cpp).
    void enter_world(); ///< finds the regions the path starts in, and its hero channel
    /// Goes to the next scattering, crossing or hit; met: what that is.
    bool step_through_media(Hit& met);
    /// A place among the grains, in the void between them, near one on the surface of a medium.
    V3d void_point(const V3d& place, const V3d& d, const Crossing& crossing);
    /// Goes through the surface of a medium, which may move the ray's start.
    void handle_crossing(const Crossing& crossing);
    /// The first scattering of the media around, between two places on the ray.
    MediumEvent medium_event(double t0, double t1);
    Color media_transmittance(RegionSet regions, const V3d& o, const V3d& d, double t0, double t1);
    /// What passes from o to a light `distance` away, of all that stands and lies between.
    Color passing(const V3d& o, const V3d& d, double distance, const Place& from, uint32_t light, RegionSet regions);
    Color passing_media(V3d o, const V3d& d, double distance, Place from, uint32_t light, RegionSet regions);

    /// How far there is nothing but media around the ray's start; 0 where that is not worth knowing.
    double clear();

    // Through shells (shell_vertex.cpp).
    /// Goes to the surface of the largest shell that fits around the path's place; whether the path goes on, or nothing
    /// where none fits.
    std::optional<bool> step_through_shell(Hit& met);
    bool diffuse_through(const FittingShell& shell, Hit& met);
    /// Leaves a place by the cosine to the normal; light_weight: of light sampled there, 0 for none.
    bool leave_by_cosine(const V3d& place, const V3d& normal, Real light_weight);
    /// Light that one of the shell's scatterings brings, for all of them; scale: of a mean free path.
    void add_event_light(const FittingShell& shell, double scale, double weight);
    /// How far to the first scattering in a shell that does scatter.
    double first_flight(const FittingShell& shell);
    /// Light that the first scattering in the shell brings.
    void add_single_light(const FittingShell& shell, double weight);
    /// Light that a phase function at a place scatters, of a way that came along `before`.
    void add_phase_light(const V3d& place, const V3d& before, const PhaseFunction& phase, const Color& weight);

    void start_ray(const V3d& o, const V3d& d, const Place& from)
    {
        o_ = o;
        d_ = d;
        from_ = from;
        beyond_ = passed_ = 0;
        crossed_ = false;
        clear_ = -1;
    }

    /// What the ray meets from outside of grains; as a proxy where it is a grain that the camera cannot resolve.
    Hit look();
    // Each handles one vertex; false when the path ends there.
    bool handle(const Hit& hit);
    bool handle_miss();
    bool handle_interface(const Hit& hit);
    bool handle_proxy(const Hit& hit);
    bool misses_proxy(const Hit& hit);
    /// Where the ray enters the sphere of a grain that it has met as it is.
    Hit as_proxy(const Hit& hit) const;
    bool handle_medium(const MediumEvent& event, Hit& met);

    void add(const Color& light) { light_ += weight_ * spectral_.weight() * Weight(light); }
    /// Russian roulette: kills with the weight's largest channel, and only what has lost a part worth it.
    bool survives();
    bool is_cut();
    void note_first(const Hit& hit, const Material& material);

    void add_direct_light(const Hit& hit, const Material& material, const Frame& frame, const V3d& wo);
    void add_proxy_light(const Hit& hit, const Encounter& encounter, uint32_t stratum);
    /// Adds what a light's sample brings over `distance`, scattered by f (per solid angle) and weighed against
    /// scatter_pdf.
    void add_light_sample(const LightSample& light, double distance, const Color& f, double scatter_pdf,
                          const Color& passed);
    /// Weight of light that scattering found, against the chance that sampling the light had of it.
    double found_weight(double light_pdf) const;
    double found_pdf(uint32_t light, double distance) const;
    void add_infinite_lights();
    void add_light(const Hit& hit);

    const World& world_;
    const Tracer& tracer_;
    Sampler& sampler_;
    const PathOptions& options_;
    const RegionTracer* media_; ///< null where there are none

    V3d o_, d_;
    Place from_;
    Place grain_; // that the path is inside of
    uint64_t last_grain_ = std::numeric_limits<uint64_t>::max(); // the last met as it is
    uint32_t explicit_left_; // grains that may still be met as they are
    const Material* surrounding_ = nullptr; // of the dielectric surface the path is inside of, outside grains
    Weight light_{0};
    Weight weight_{1};
    Scattering last_;
    RegionSet regions_ = 0; // that the path is in
    Crossing crossing_; // the last on this ray, if crossed_
    bool crossed_ = false;
    double clear_ = -1; // around the ray's start nothing but media is nearer; below 0: not asked yet
    double passed_ = 0; // along the ray: up to there media and their surfaces are behind
    double moved_ = 0; // how far the camera's ray came before its start was moved
    SpectralState spectral_;
    bool is_spectral_ = false; // some medium's sigma_t depends on the channel
    double beyond_ = 0; // along the ray: where the last of the proxies was met that it missed
    bool unresolved_ = false; // what look() found is a proxy, met for certain
    uint32_t depth_ = 0;
    uint64_t steps_ = 0;
    PathResult result_;
};

} // namespace scree
