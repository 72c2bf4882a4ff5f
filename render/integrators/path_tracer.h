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
    uint32_t explicit_grains =
        all_grains; ///< grains of a path that are traced as they are; those after them are proxies
    /// A grain narrower than this at its distance along the camera's ray (render coordinates), as it is met first, is a
    /// proxy, and so are all after it.
    PixelSize resolved;
    uint32_t max_depth = 0; ///< scattering events after which a path is cut, which biases; 0: never
    std::function<bool()>
        stop; ///< asked every 65,536 segments: a path that cannot end (white walls all around) is given up
};

/// One vertex of a replayed path.
struct PathVertex {
    V3d o, d; ///< the ray that was traced, render coordinates
    Hit hit;
    bool inside = false;
    Weight weight, radiance; ///< of the path up to here, after the vertex was handled
};

struct PathResult {
    Color radiance{0};
    V3d last_direction{0}; ///< in which it left, or met its light
    FirstHit first;
    uint32_t segments = 0; ///< rays traced, shadow rays not counted
    uint32_t shadow_rays = 0;
    uint32_t events = 0; ///< scatterings in media, those within shells not counted
    uint32_t shells = 0; ///< gone through in one step
    uint32_t leaks = 0; ///< rays inside a mesh that rounding let escape
    bool cut = false; ///< by max_depth
    bool stopped = false; ///< by PathOptions::stop: no sample
};

/// The radiance along a ray by path tracing, unidirectional, with next-event estimation and multiple importance
/// sampling (Veach 1997, power heuristic), no clamp and no bound on length, Russian roulette on the weight.
///
/// The first `explicit_grains` grains of a path are traced as they are (explicit path tracing, EPT: unbiased). Further
/// ones are proxies (proxy path tracing, PPT: Müller et al. 2016, algorithm 1): their types need a GSDF. Weights carry
/// basic radiance L / n^2 (see bsdf.h). `trail`, if given, receives every vertex.
PathResult trace_path(const World& world, const Tracer& tracer, V3d o, V3d d, Sampler& sampler,
                      const PathOptions& options = {}, std::vector<PathVertex>* trail = nullptr);

} // namespace scree
