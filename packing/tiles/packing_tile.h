#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

struct ParticleFrame;

/// Whole spheres in a periodic cuboid: the piece that a fill repeats without end.
///
/// The tile comes in interchangeable variants. Each row is one sphere: its radius and type are the same in every
/// variant. Rows below `shared` (all that reach through a face of the cuboid, and perhaps more) also have the same
/// place in each variant; the others lie wholly inside the cuboid. So any variant fits beside any other, like Wang
/// tiles.
/// Spheres may touch, their periodic images included; overlaps are at most 1e-6 of the smaller radius.
struct PackingTile {
    Imath::V3d size{1}; ///< edges of the cuboid, in tile units
    std::vector<float> radius; ///< by row, in tile units
    std::vector<int32_t> type; ///< by row: type number of the dump the tile was cut from, else 1
    uint32_t shared = 0; ///< the first rows, which have the same place in every variant
    std::vector<std::vector<Imath::V3d>> variants; ///< at least one: places by row, 0 <= x < size.x, ...

    uint64_t rows() const { return radius.size(); }
    /// Volume of the spheres over that of the cuboid.
    double fraction() const;
    double mean_radius() const;
    double largest_radius() const;
};

/// One variant as a frame with a periodic box; ids are rows.
ParticleFrame tile_frame(const PackingTile& tile, size_t variant);

/// Writes a tile as OpenVDB points: a grid "points" (variant 0; `id` is the row), which is a complete periodic packing
/// on its own, and a grid "variant_1", ... for each other variant. Throws InputError.
void write_tile(const PackingTile& tile, const std::filesystem::path& path);

/// Reads a tile from any .vdb file of points whose box is a periodic cuboid. Throws InputError, also for spheres that
/// overlap by more than 1e-6 of a radius (naming their ids) and for variants that do not fit each other.
PackingTile read_tile(const std::filesystem::path& path);

/// The largest (r_i + r_j - d) / min(r_i, r_j) of the spheres in a periodic cuboid, images included. A negative value
/// is minus the smallest gap between near neighbours; it is -1 (rows 0, 0) where no gap is smaller than that. rows: the
/// two spheres, or one sphere and its image.
struct TileOverlap {
    double overlap = 0;
    uint64_t rows[2] = {0, 0};
};
TileOverlap largest_tile_overlap(const PackingTile& tile, size_t variant);

} // namespace scree
