#pragma once

#include "base/progress.h"
#include "packing/tiles/tile_spheres.h"

#include <functional>

namespace scree {

/// Tells how much of the work, 0..1, is done.
using TileStep = std::function<void(double)>;

/// Moves spheres, from where they are, until none overlap with their radii times `goal`; where they jam before, they
/// are left at the largest scale found at which they do not overlap. Returns the scale reached, at most `goal`.
///
/// The spheres are relaxed (see TileRelaxation) with radii a hair larger than those of the goal, so that they end up
/// strictly apart (at least some 1e-7 radii). When the forces balance instead, the packing is jammed: radii are made
/// smaller step by step, each to a tenth of the overlap as the last two steps extrapolate it (for harmonic springs
/// overlap is linear in the distance from jamming; O'Hern et al. 2003), down to overlaps of 1e-5, and then by the worst
/// overlap left. Throws Cancelled.
double settle_spheres(TileSpheres& spheres, double goal, const TileStep& step, const Progress& progress);

/// The scale of the radii at which the spheres jam: compresses them, from where they are, to the fraction `overfull`
/// and beyond until they are jammed, and decompresses as above. Leaves the spheres at that scale without overlap.
///
/// rounds: compressions, each of which finds a closer packing than the one before; all but the last are let go down to
/// overlaps of some per cent only. Throws Cancelled.
double jam_spheres(TileSpheres& spheres, double overfull, int rounds, const TileStep& step, const Progress& progress);

/// The least distance between surfaces that a packing keeps, so that rounding in files makes no overlap.
double storage_gap(const TileSpheres& spheres);

} // namespace scree
