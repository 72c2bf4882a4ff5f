#pragma once

// Private to the integrators: one light path in progress, and how it handles each kind of vertex.

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
        : world_(world), tracer_(tracer), sampler_(sampler), options_(options),
          region_tracer_(tracer.regions()), grains_{.explicit_left = options.explicit_grains}
    {
    }

    PathResult run(V3d o, V3d d, std::vector<PathVertex>* trail);

private:
    /// The ray being traced. It ends at a vertex; it continues past a proxy that it misses and past a medium's surface.
    struct Ray {
        V3d o, d;
        Place from; ///< where the ray starts; it cannot hit this again
        double beyond = 0; ///< distance of the last proxy that the ray missed
        double passed = 0; ///< distance up to which media and their surfaces have been handled
        std::optional<Crossing> crossed; ///< the last surface of a medium that the ray crossed
        double clear = -1; ///< radius around o that contains only media; negative: not computed
    };

    /// Grains on the path.
    struct Grains {
        Place inside{}; ///< the grain that contains the path's point, if any
        uint64_t last = std::numeric_limits<uint64_t>::max(); ///< last grain traced as explicit geometry
        uint32_t explicit_left; ///< how many more grains may be
    };

    /// Media around the path.
    struct Media {
        RegionSet regions = 0; ///< regions that contain the path's point
        SpectralState spectral;
        bool is_spectral = false; ///< some medium's sigma_t depends on the channel
    };

    /// How the last scattering could have sampled the lights; gives the MIS weight of a light that the path then hits.
    struct Scattering {
        bool specular = true; ///< the scattering (or the camera) could not sample lights
        double pdf = 0; ///< per solid angle, of the direction taken
        V3d seen_from{0}; ///< point from which lights were sampled
        bool elsewhere = false; ///< the ray starts elsewhere: a light's pdf is of the ray from seen_from that hits it
    };

    /// What a ray hits. unresolved: a grain too narrow for the camera to resolve, so a proxy that cannot be missed.
    struct Sight {
        Hit hit;
        bool unresolved = false;
    };

    /// Whether a grain that the camera sees is wide enough for its geometry to show.
    bool is_resolved(const Hit& hit) const
    {
        const double pixel = options_.resolved.width + options_.resolved.slope * (moved_ + hit.t);
        return !(2 * world_.sphere(hit.place.index).radius < pixel);
    }
    bool is_inside() const { return grains_.inside.kind == HitKind::grain; }
    GrainDetail detail() const { return grains_.explicit_left > 0 ? GrainDetail::as_is : GrainDetail::proxy; }
    /// The same inside these regions, one of which may replace the grains.
    GrainDetail detail(RegionSet regions) const
    {
        return region_tracer_ && (regions & region_tracer_->instead_of_grains()) != 0 ? GrainDetail::none : detail();
    }
    bool samples_lights() const
    {
        return world_.lights.any_sampled() && options_.direct_light != DirectLight::scattering_only;
    }
    const Material& material_of(const Place& grain) const { return world_.types[grain.type].material; }
    static Weight transmittance(const Material& medium, double length);
    void attenuate(const Material* medium, double length)
    {
        if (medium) weight_ *= transmittance(*medium, length);
    }
    /// The medium that contains the path's point; null if there is none, or more than one.
    const MediumRegion* only_region() const;

    // Media along the ray (medium_vertex.cpp).
    void enter_world(); ///< finds the regions at the path's start, and chooses the hero channel
    /// Goes to the next scattering, surface of a medium, or hit; met: this event.
    bool step_through_media(Hit& met);
    /// A point in the void between the grains, near `place` on the surface of a medium.
    V3d void_point(const V3d& place, const V3d& d, const Crossing& crossing);
    /// Crosses the surface of a medium. If the ray comes back among grains, it starts again there.
    void handle_crossing(const Crossing& crossing);
    /// The first scattering in the current media, between two distances along the ray.
    MediumEvent medium_event(double t0, double t1);
    Color media_transmittance(RegionSet regions, const V3d& o, const V3d& d, double t0, double t1);
    /// The fraction of light that gets from a light `distance` away to o, past geometry and through media.
    Color passing(const V3d& o, const V3d& d, double distance, const Place& from, uint32_t light, RegionSet regions);
    Color passing_media(V3d o, const V3d& d, double distance, Place from, uint32_t light, RegionSet regions);

    /// Radius around the ray's start that contains only media; 0 where it would be of no use.
    double clear();

    // Shells (shell_vertex.cpp).
    /// Goes to the surface of the largest shell that fits around the ray's start. Returns whether the path goes on;
    /// nothing if no shell fits.
    std::optional<bool> step_through_shell(Hit& met);
    bool diffuse_through(const FittingShell& shell, Hit& met);
    /// Leaves `place` in a cosine-distributed direction. light_weight: of a light sampled there; 0: no light is
    /// sampled.
    bool leave_by_cosine(const V3d& place, const V3d& normal, Real light_weight);
    /// Adds light at one scattering in the shell, which represents all of them. scale: length of a mean free path.
    void add_event_light(const FittingShell& shell, double scale, double weight);
    /// Distance to the first scattering in a shell, given that light scatters in it.
    double first_flight(const FittingShell& shell);
    /// Adds light at the first scattering in the shell.
    void add_single_light(const FittingShell& shell, double weight);
    /// Adds light that scatters at `place`, to which the path came along `before`.
    void add_phase_light(const V3d& place, const V3d& before, const PhaseFunction& phase, const Color& weight);

    /// clear: see Ray.
    void start_ray(const V3d& o, const V3d& d, const Place& from, double clear = -1)
    {
        ray_ = {o, d, from, 0, 0, std::nullopt, clear};
    }

    /// What the ray hits outside grains.
    Sight look();
    // Each handles one vertex and returns whether the path goes on.
    bool handle(const Sight& sight);
    bool handle_miss();
    bool handle_interface(const Hit& hit);
    bool handle_proxy(const Hit& hit);
    bool misses_proxy(const Hit& hit);
    /// Where the ray enters the bounding sphere of a grain whose geometry it hit.
    Hit as_proxy(const Hit& hit) const;
    bool handle_medium(const MediumEvent& event, Hit& met);

    void add(const Color& light) { light_ += weight_ * media_.spectral.weight() * Weight(light); }
    /// Russian roulette by the weight's largest channel, once enough light is lost to make it worthwhile.
    bool survives();
    bool is_cut();
    void note_first(const Hit& hit, const Material& material);

    void add_direct_light(const Hit& hit, const Material& material, const Frame& frame, const V3d& wo);
    void add_proxy_light(const Hit& hit, const Encounter& encounter, uint32_t stratum);
    /// Adds a light sample at `distance`, scattered by f (per solid angle), MIS-weighted against scatter_pdf.
    void add_light_sample(const LightSample& light, double distance, const Color& f, double scatter_pdf,
                          const Color& passed);
    /// MIS weight of a light hit after scattering, against the density with which light sampling finds it.
    double found_weight(double light_pdf) const;
    double found_pdf(uint32_t light, double distance) const;
    void add_infinite_lights();
    void add_light(const Hit& hit);

    const World& world_;
    const Tracer& tracer_;
    Sampler& sampler_;
    const PathOptions& options_;
    const RegionTracer* region_tracer_; ///< null where there are no media

    Ray ray_;
    Grains grains_;
    Media media_;
    const Material* surrounding_ = nullptr; ///< of the dielectric surface around the path (not of a grain); or null
    Scattering last_;
    Weight light_{0}; ///< found so far
    Weight weight_{1}; ///< throughput
    double moved_ = 0; ///< distance along the camera's ray to where it was last restarted
    uint32_t depth_ = 0; ///< scattering events
    uint64_t steps_ = 0;
    PathResult result_;
};

} // namespace scree
