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
    /// Volume of the spheres over that of the cuboid; nothing: as dense as they get, jammed.
    std::optional<double> fraction;
    uint32_t variants = 4;
    uint64_t seed = 0;
    /// Monte Carlo sweeps; nothing: as many as a fluid needs up to fraction `densest_fluid`, none above.
    std::optional<uint64_t> sweeps;

    /// Hard spheres of one size freeze above 0.494; a little above that the fluid still lasts for much longer than a
    /// run.
    static constexpr double densest_fluid = 0.52;
};

struct MadeTile {
    PackingTile tile;
    double radius_scale = 1; ///< radii of the tile over the radii given
    double jammed_fraction = 0; ///< of variant 0 on its own, where it was packed until it jammed; else 0
    bool fluid = false; ///< whether the places are a sample of the hard-sphere fluid
    FluidRun fluid_run; ///< of variant 0
    double mean_shift = 0, largest_shift = 0; ///< how far spheres of a frame were moved, in mean radii
};

/// Packs spheres in a periodic cuboid.
///
/// radii: up to a common scale, which the fraction decides. From random places the spheres are moved apart as soft
/// spheres of the final radii (or are jammed, see tile_jamming.h); fluids are then brought to equilibrium
/// (tile_fluid.h). Further variants: make_tile_variants. The same tile for the same seed on any number of threads.
/// Throws InputError, also when the spheres jam before the fraction (naming the largest reached), and Cancelled.
MadeTile make_tile(std::span<const double> radii, const TileOptions& options, const Progress& progress);

/// Makes the spheres of a frame, whose box must be a cuboid that is periodic in all directions, a tile in the frame's
/// unit of length.
///
/// The spheres start where they are and move only as far as it takes to part them; where they jam at their radii, all
/// radii become smaller by one factor. Of the options, variants, seed and sweeps (for the variants) count. place: for
/// errors. Throws InputError, Cancelled.
MadeTile tile_from_frame(const ParticleFrame& frame, const std::string& place, const TileOptions& options,
                         const Progress& progress);

/// The frame's spheres with centres in the cuboid lo..hi, as a frame that is periodic there. Throws InputError.
ParticleFrame cut_cuboid(const ParticleFrame& frame, const Imath::V3d& lo, const Imath::V3d& hi,
                         const std::string& place);

} // namespace scree
