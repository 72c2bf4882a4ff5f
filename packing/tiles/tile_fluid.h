#pragma once

#include "base/progress.h"
#include "packing/tiles/tile_jamming.h"
#include "packing/tiles/tile_spheres.h"

#include <cstdint>
#include <optional>

namespace scree {

struct FluidRun {
    uint64_t sweeps = 0; ///< moves tried a sphere
    double acceptance = 0; ///< of the moves, after the step lengths were tuned
    double displacement = 0; ///< root mean square over moving spheres, images followed
};

/// Brings spheres without overlap to the equilibrium of the hard-sphere fluid, by Metropolis Monte Carlo moves of one
/// sphere at a time.
///
/// A sweep tries each moving sphere once, in order of its row (that keeps the balance: Manousiouthakis, Deem, JCP 110,
/// 2753, 1999), to a place uniform in a cube around its own. The cube's edge is tuned for each level of radii in the
/// first sweeps and then kept. Without a number of sweeps it goes on until spheres have moved by two mean spacings,
/// (volume / spheres)^(1/3), in root mean square, for 200 sweeps at least and 5,000 at most. With `fixed` above 0 the
/// first spheres stay and the others remain wholly inside the cuboid, which is the equilibrium given the fixed ones.
/// Deterministic in seed. Throws Cancelled.
FluidRun equilibrate_spheres(TileSpheres& spheres, uint64_t fixed, std::optional<uint64_t> sweeps, uint64_t seed,
                             const TileStep& step, const Progress& progress);

} // namespace scree
