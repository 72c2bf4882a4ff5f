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
    uint32_t spp = 64; ///< samples a pixel; with a timeout and no spp of its own, as many as the time allows
    double error =
        0; ///< relative, at which to stop (see AdaptivePlan); 0: at spp alone, of which there are at least 4 else
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
    uint64_t shells = 0; ///< of media, gone through in one step
    uint64_t non_finite = 0; ///< samples dropped for not being finite
    uint64_t leaks = 0; ///< rays that rounding let out of a mesh between two of its triangles
    uint64_t stopped = 0; ///< paths given up because time ran out or the user stopped
    uint64_t cut = 0; ///< paths ended by a depth limit the user set
    uint32_t longest = 0; ///< segments of the longest path
    uint32_t spp = 0; ///< samples every pixel has at least
    double mean_spp = 0; ///< over the pixels; more than spp where an error is asked for
    double seconds = 0;
    bool cancelled = false; ///< stopped by the user: pixels may differ in their number of samples
    bool timed_out = false;
    std::optional<SamplePlace> first_non_finite;

    /// Counts what another call or part of one did as well; what is said of a picture (spp, error, how it ended) stays.
    void add(const RenderStatistics& part);
    std::optional<ErrorClaim> error; ///< of the film, where one was asked for
    bool error_reached = false; ///< every tile has the samples it was found to need
};

/// Adds samples to every pixel of the film, in waves over tiles on all threads of the caller's arena, until spp, the
/// error, timeout or cancellation. A sample depends on (seed, pixel, number) alone. Continues where the film stands.
RenderStatistics render(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter,
                        Film& film, const RenderOptions& options, const Progress& progress);

/// One sample of one pixel: what `render` adds, with every vertex in `trail` if given.
PathResult render_sample(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter, int x,
                         int y, uint32_t sample, const RenderOptions& options,
                         std::vector<PathVertex>* trail = nullptr);

} // namespace scree
