#pragma once

#include "base/enum_names.h"
#include "base/sampler.h"
#include "render/film/film.h"
#include "render/film/pixel_size.h"
#include "render/trace/tracer.h"

#include <functional>
#include <vector>

namespace scree {

/// How direct light is found: by both strategies (weighed), or by one alone, for tests.
enum class DirectLight : uint8_t { both, lights_only, scattering_only };
inline const EnumNames<DirectLight> direct_light_names{
    {DirectLight::both, "both"}, {DirectLight::lights_only, "lights"}, {DirectLight::scattering_only, "scattering"}};

struct PathOptions {
    DirectLight direct_light = DirectLight::both;
    uint32_t explicit_grains = all_grains; ///< grains of a path traced as explicit geometry; later ones are proxies
    /// If the first grain on a camera ray is narrower than this at its distance (render coordinates), this grain and
    /// all later ones are proxies.
    PixelSize resolved;
    uint32_t max_depth = 0; ///< scattering events after which a path is cut (biased); 0: never
    /// Called every 65,536 steps of a path; if true, the path is given up (white walls all around never end a path).
    std::function<bool()> stop;
};

/// One vertex of a replayed path.
struct PathVertex {
    V3d o, d; ///< the ray that was traced, render coordinates
    Hit hit;
    bool inside = false;
    Weight weight, radiance; ///< of the path so far, after the vertex was handled
};

struct PathResult {
    Color radiance{0};
    V3d last_direction{0}; ///< in which the path left the scene or hit a light
    FirstHit first;
    uint32_t segments = 0; ///< rays traced, shadow rays not counted
    uint32_t shadow_rays = 0;
    uint32_t events = 0; ///< scatterings in media, without those inside shells
    uint32_t shells = 0; ///< shells crossed in one step
    uint32_t leaks = 0; ///< rays inside a mesh that escaped by rounding
    bool cut = false; ///< by max_depth
    bool stopped = false; ///< by PathOptions::stop: not a sample
};

/// The radiance along a ray by path tracing, unidirectional, with next-event estimation and multiple importance
/// sampling (Veach 1997, power heuristic), Russian roulette on the weight, no clamp and no limit on length.
///
/// The first `explicit_grains` grains of a path are traced as explicit geometry (explicit path tracing, EPT: unbiased).
/// Further grains are proxies (proxy path tracing, PPT: Müller et al. 2016, algorithm 1), and their types need a GSDF.
/// Weights carry basic radiance L / n^2 (see bsdf.h). Every vertex is appended to `trail`, if given.
PathResult trace_path(const World& world, const Tracer& tracer, V3d o, V3d d, Sampler& sampler,
                      const PathOptions& options = {}, std::vector<PathVertex>* trail = nullptr);

} // namespace scree
