#pragma once

#include "base/progress.h"
#include "packing/tiles/tile_jamming.h"
#include "packing/tiles/tile_spheres.h"

#include <cstdint>
#include <optional>

namespace scree {

struct FluidRun {
    uint64_t sweeps = 0; ///< moves tried per sphere
    double acceptance = 0; ///< share of accepted moves, after the step lengths were tuned
    double displacement = 0; ///< root mean square over the moving spheres, unwrapped across periodic images
};

/// Brings spheres without overlap to the equilibrium of the hard-sphere fluid, by Metropolis Monte Carlo moves of
/// single spheres.
///
/// A sweep tries to move each moving sphere once, in the order of rows (which keeps the balance: Manousiouthakis, Deem,
/// JCP 110, 2753, 1999), to a place uniform in a cube around its own. The cube's edge is tuned for each level of radii
/// in the first sweeps and then kept. Without a given number of sweeps, the run ends when the root mean square
/// displacement is two mean spacings, (volume / spheres)^(1/3), after 200 sweeps at least and 5,000 at most. With
/// `fixed` above 0 the first `fixed` spheres stay in place, and the others remain wholly inside the cuboid; the result
/// is the equilibrium given the fixed spheres. Deterministic in seed. Throws Cancelled.
FluidRun equilibrate_spheres(TileSpheres& spheres, uint64_t fixed, std::optional<uint64_t> sweeps, uint64_t seed,
                             const TileStep& step, const Progress& progress);

} // namespace scree
