#pragma once

#include "base/progress.h"
#include "ingest/particles/particle_frame.h"
#include "packing/tiles/packing_tile.h"
#include "packing/tiles/tile_fluid.h"

#include <optional>
#include <span>
#include <vector>

namespace scree {

struct TileOptions {
    Imath::V3d size{1};
    /// Volume of the spheres over that of the cuboid; nothing: as dense as possible (jammed).
    std::optional<double> fraction;
    uint32_t variants = 4;
    uint64_t seed = 0;
    /// Monte Carlo sweeps; nothing: as many as a fluid needs up to fraction `densest_fluid`, and none above.
    std::optional<uint64_t> sweeps;

    /// Hard spheres of one size freeze above 0.494. A little above that, the fluid still lasts much longer than a run.
    static constexpr double densest_fluid = 0.52;
};

struct MadeTile {
    PackingTile tile;
    double radius_scale = 1; ///< radii of the tile over the given radii
    double jammed_fraction = 0; ///< of variant 0 on its own, if it was packed until it jammed; else 0
    bool fluid = false; ///< whether the places are a sample of the hard-sphere fluid
    FluidRun fluid_run; ///< of variant 0
    double mean_shift = 0, largest_shift = 0; ///< how far a frame's spheres were moved, in mean radii
};

/// Packs spheres in a periodic cuboid.
///
/// radii: up to a common scale, which follows from the fraction. The spheres start at random places and are moved apart
/// as soft spheres of their final radii (or are jammed, see tile_jamming.h). Fluids are then brought to equilibrium
/// (tile_fluid.h). Further variants: tile_variants.h. The same seed gives the same tile on any number of threads.
/// Throws Cancelled, and InputError, also when the spheres jam below the fraction (naming the largest one reached).
MadeTile make_tile(std::span<const double> radii, const TileOptions& options, const Progress& progress);

/// Makes a tile from a frame's spheres, in the frame's unit of length; the frame's box must be a cuboid that is
/// periodic in all directions.
///
/// The spheres start at their places and move only as far as needed to remove overlaps. Where they jam at their own
/// radii, all radii shrink by one factor. Only the options variants, seed and sweeps (for the variants) are used.
/// place: for errors. Throws InputError, Cancelled.
MadeTile tile_from_frame(const ParticleFrame& frame, const std::string& place, const TileOptions& options,
                         const Progress& progress);

/// The frame's spheres with centres in the cuboid lo..hi, as a frame that is periodic in it. Throws InputError.
ParticleFrame cut_cuboid(const ParticleFrame& frame, const Imath::V3d& lo, const Imath::V3d& hi,
                         const std::string& place);

} // namespace scree
