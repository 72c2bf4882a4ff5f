#pragma once

#include "base/progress.h"
#include "packing/tiles/tile_spheres.h"

#include <functional>

namespace scree {

/// Reports which part of the work, 0..1, is done.
using TileStep = std::function<void(double)>;

/// Moves spheres from their places until none overlap with their radii times `goal`. If they jam at a smaller scale,
/// they are left at the largest scale found without overlap. Returns the scale reached, at most `goal`.
///
/// The spheres are relaxed (see TileRelaxation) with radii slightly larger than the goal's, so that they end strictly
/// apart (by at least some 1e-7 radii). If the forces balance instead, the packing is jammed, and the radii shrink in
/// steps. Each step aims at a tenth of the overlap, extrapolated from the last two steps (for harmonic springs the
/// overlap is linear in the distance from jamming; O'Hern et al. 2003), down to overlaps of 1e-5. The last step is by
/// the worst remaining overlap. Throws Cancelled.
double settle_spheres(TileSpheres& spheres, double goal, const TileStep& step, const Progress& progress);

/// Finds the scale of the radii at which the spheres jam: compresses them from their places to the fraction `overfull`,
/// or beyond until they jam, and decompresses as settle_spheres does. Leaves the spheres at that scale without overlap.
///
/// rounds: number of compressions, each of which finds a denser packing than the one before; all but the last are
/// decompressed only down to overlaps of some per cent. Throws Cancelled.
double jam_spheres(TileSpheres& spheres, double overfull, int rounds, const TileStep& step, const Progress& progress);

/// The smallest gap between surfaces that a packing keeps, so that rounding in files causes no overlap.
double storage_gap(const TileSpheres& spheres);

} // namespace scree
