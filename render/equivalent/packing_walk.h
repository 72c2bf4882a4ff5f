#pragma once

#include "base/progress.h"
#include "render/equivalent/walk_statistics.h"
#include "render/trace/tracer.h"

#include <array>

namespace scree {

struct PackingWalkOptions {
    uint64_t seed = 0;
    uint64_t scatterings = 600000; ///< wanted in all, about
    uint32_t memory = 0; ///< as of WalkBatch; 0: as long as a short walk beforehand says
    uint32_t length = 0; ///< scatterings of a walk; 0: 8 `memory`
    V3d centre{0}; ///< walks start within start_radius of it
    double start_radius = 0;
    double safe_radius = 0; ///< and end early where they leave this
};

/// What a lossless walk among a packing's proxies tells of the medium that stands for it; lengths in render units.
struct PackingWalk {
    Measured void_flight; ///< mean chord of the voids, 4 (1 - f) <r^3> / (3 f <r^2>) where spheres do not overlap
    Measured flight; ///< from scattering to scattering
    Measured cosine; ///< mean of a scattering's
    Measured diffusivity; ///< D = lim <x^2> / (2 n)
    Measured transport_length; ///< l* = <sum of steps . w_0>
    Measured half_diffusivity, half_transport_length; ///< with half the memory, to see that it was enough
    std::array<PackingDecay, 3> decay; ///< per channel
    uint32_t memory = 0, length = 0;
    uint64_t walks = 0, scatterings = 0;
    uint64_t left = 0; ///< walks that left the safe ball or met what is no grain, and ended there
    double seconds = 0;
};

/// Walks light through the grains of a world as proxies (Müller et al. 2016, algorithm 1).
///
/// Walks start as light that fills the packing meets grains: where lines at random enter bounding spheres, all entries
/// within a length of a line counting alike. As a GSDF is reciprocal each of their scatterings is then a fair sample,
/// and all of them are used; see WalkStatistics.
///
/// Every type needs a GSDF. The same result for any number of threads. Throws InputError (no grains there) and
/// Cancelled.
PackingWalk walk_packing(const World& world, const Tracer& tracer, const PackingWalkOptions& options,
                         const Progress& progress = {});

} // namespace scree
