#include "packing/tiles/tile_jamming.h"

#include "packing/tiles/tile_relaxation.h"

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

using Outcome = TileRelaxation::Outcome;

// Forces balance when net force / mean contact force is below `balance`. A looser limit takes fewer steps, but the
// packings jam earlier: at 3e-2, by 0.004 in fraction. Below a mean overlap of `settled` no sphere changes its
// neighbours any more, and a limit of 5e-2 gives the same packing (to 1e-4 in fraction) in half the steps.
constexpr double balance = 1e-2, settled = 1e-3;
// Overlaps, as part of the sum of radii.
constexpr double hair = 2e-5; // by how much radii are enlarged while spheres are moved apart
constexpr double close_enough = 1e-5; // worst overlap at which decompression ends
constexpr double rough = 8e-2; // the same, before the spheres are compressed again

/// The progress of decompression: by the logarithm of the overlap, from 0.3 down.
double progress_of(double worst_overlap)
{
    return std::clamp(1 - std::log(worst_overlap / close_enough) / std::log(0.3 / close_enough), 0.0, 1.0);
}

/// Decompresses from a jammed state at `scale` until overlaps are at most `enough`; returns the scale reached.
double decompress(TileRelaxation& soft, double scale, double enough, const TileStep& step, const Progress& progress)
{
    double above = 0, overlap_above = 0; // the previous state
    double below = 0; // a scale without overlap
    for (int stages = 0; stages < 40; ++stages) {
        const TileRelaxation::State& state = soft.state();
        step(progress_of(state.worst_overlap));
        if (state.worst_overlap < enough || scale - below < close_enough * scale) break;
        const double overlap = state.mean_overlap;
        const double slope = above > 0 && overlap_above > overlap ? (above - scale) / (overlap_above - overlap) : scale;
        const double jammed = scale - std::min(overlap * slope, 4 * overlap * scale);
        double next = scale - 0.9 * (scale - jammed);
        if (next <= below) next = (scale + below) / 2;
        above = scale;
        overlap_above = overlap;
        while (
            soft.relax(
                next,
                {.allowed = close_enough / 20, .balance = overlap < settled ? 5 * balance : balance, .max_steps = 4000},
                progress) == Outcome::separated &&
            scale - next > close_enough * scale) {
            below = next;
            next = (scale + next) / 2;
        }
        scale = next;
    }
    return scale;
}

} // namespace

double storage_gap(const TileSpheres& spheres)
{
    // Files round places along each axis by up to 2^-26 of a voxel of four mean radii (vdb_points.h); the errors of two
    // spheres on three axes add up.
    return 5e-7 * spheres.mean_radius();
}

double settle_spheres(TileSpheres& spheres, double goal, const TileStep& step, const Progress& progress)
{
    const double gap = storage_gap(spheres);
    if (fitting_scale(spheres, gap, goal).scale >= goal) return goal;
    TileRelaxation soft(spheres);
    const double scale = goal * (1 + hair);
    const Outcome outcome = soft.relax(scale, {.allowed = hair / 2, .balance = balance, .max_steps = 10000}, progress);
    if (outcome == Outcome::separated) {
        spheres.place = soft.places();
        return fitting_scale(spheres, gap, goal).scale;
    }
    decompress(soft, scale, close_enough, step, progress);
    spheres.place = soft.places();
    return fitting_scale(spheres, gap, goal).scale;
}

double jam_spheres(TileSpheres& spheres, double overfull, int rounds, const TileStep& step, const Progress& progress)
{
    TileRelaxation soft(spheres);
    double compressed = cube_root(overfull / spheres.fraction()), scale = compressed;
    for (int round = 0; round < rounds; ++round) {
        const bool last = round + 1 == rounds;
        while (soft.relax(compressed, {.allowed = close_enough, .balance = balance, .max_steps = 4000}, progress) ==
               Outcome::separated)
            compressed *= 1.02;
        scale = decompress(
            soft, compressed, last ? close_enough : rough, [&](double part) { step((round + part) / rounds); },
            progress);
    }
    spheres.place = soft.places();
    return fitting_scale(spheres, storage_gap(spheres), scale).scale;
}

} // namespace scree
