#pragma once

#include "base/progress.h"
#include "render/equivalent/walk_statistics.h"
#include "render/trace/tracer.h"

#include <array>

namespace scree {

struct PackingWalkOptions {
    uint64_t seed = 0;
    uint64_t scatterings = 600000; ///< approximate total number wanted
    uint32_t memory = 0; ///< memory of WalkBatch; 0: determined by a short pilot walk
    uint32_t length = 0; ///< scatterings per walk; 0: 8 `memory`
    V3d centre{0}; ///< random lines, on which walks start, begin within start_radius of it
    double start_radius = 0;
    double safe_radius = 0; ///< walks end early when they are farther than this from `centre`
};

/// Results of a lossless walk among a packing's proxies, from which an equivalent medium is computed; lengths in render
/// units.
struct PackingWalk {
    Measured void_flight; ///< mean chord of the voids, 4 (1 - f) <r^3> / (3 f <r^2>) where spheres do not overlap
    Measured flight; ///< distance from scattering to scattering
    Measured cosine; ///< mean scattering cosine
    Measured diffusivity; ///< D = lim <x^2> / (2 n)
    Measured transport_length; ///< l* = <sum of steps . w_0>
    Measured half_diffusivity, half_transport_length; ///< with half the memory, to check that the memory is long enough
    std::array<PackingDecay, 3> decay; ///< per channel
    uint32_t memory = 0, length = 0;
    uint64_t walks = 0, scatterings = 0;
    uint64_t left = 0; ///< walks that ended because they left the safe ball or hit something other than a grain
    double seconds = 0;
};

/// Random walks of light through the grains of a world as proxies (Müller et al. 2016, algorithm 1).
///
/// Walks start where light that fills the packing hits grains: at the entries of random lines into bounding spheres;
/// all entries within a fixed length of a line count equally. As a GSDF is reciprocal, each scattering of such a walk
/// is an unbiased sample, and all of them are used; see WalkStatistics.
///
/// Every type needs a GSDF. The result is the same for any number of threads. Throws InputError (a type without GSDF,
/// too few grains around `centre`, no grain that scatters) and Cancelled.
PackingWalk walk_packing(const World& world, const Tracer& tracer, const PackingWalkOptions& options,
                         const Progress& progress = {});

} // namespace scree
