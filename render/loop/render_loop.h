#pragma once

#include "base/progress.h"
#include "render/film/film.h"
#include "render/film/filter.h"
#include "render/integrators/path_tracer.h"
#include "render/loop/adaptive.h"
#include "render/scene/camera.h"

#include <optional>

namespace scree {

struct RenderOptions {
    uint32_t spp = 64; ///< samples per pixel; at most as many if `error` or `timeout` is set
    double error = 0; ///< relative error at which to stop (see AdaptivePlan; needs spp >= 4); 0: stop at spp
    double timeout = 0; ///< seconds; 0: none
    uint64_t seed = 0;
    PathOptions path;
};

/// The first sample that went wrong, for --debug-sample.
struct SamplePlace {
    int x, y;
    uint32_t sample;
};

struct RenderStatistics {
    uint64_t paths = 0, segments = 0, shadow_rays = 0, events = 0; ///< events: scatterings in media
    uint64_t shells = 0; ///< shells of media, each crossed in one step
    uint64_t non_finite = 0; ///< samples dropped because they are not finite
    uint64_t leaks = 0; ///< rays that left a mesh between two of its triangles by rounding
    uint64_t stopped = 0; ///< paths given up because time ran out or the user stopped
    uint64_t cut = 0; ///< paths ended by a depth limit the user set
    uint32_t longest = 0; ///< segments of the longest path
    uint32_t spp = 0; ///< samples every pixel has at least
    double mean_spp = 0; ///< mean over the pixels; more than spp when `error` is set
    double seconds = 0;
    bool cancelled = false; ///< stopped by the user: pixels may differ in their number of samples
    bool timed_out = false;
    std::optional<SamplePlace> first_non_finite;

    /// Adds the counts of another call, or of a part of one; values of the picture (spp, error, how it ended) stay.
    void add(const RenderStatistics& part);
    std::optional<ErrorClaim> error; ///< of the film, if RenderOptions::error is set
    bool error_reached = false; ///< every tile has the samples that it needs
};

/// Adds samples to every pixel of the film until spp, the error, the timeout or cancellation. Works in waves over tiles
/// on all threads of the caller's arena. A sample depends on (seed, pixel, number) alone. Samples already in the film
/// are kept.
RenderStatistics render(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter,
                        Film& film, const RenderOptions& options, const Progress& progress);

/// One sample of one pixel, as render() adds it; appends every vertex to `trail`, if given.
PathResult render_sample(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter, int x,
                         int y, uint32_t sample, const RenderOptions& options,
                         std::vector<PathVertex>* trail = nullptr);

} // namespace scree
