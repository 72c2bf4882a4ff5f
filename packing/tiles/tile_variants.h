#pragma once

#include "packing/tiles/tile_generator.h"

namespace scree {

/// Puts the rows first whose spheres reach through (or nearly touch) a face of the cuboid, the others after them, each
/// in their order; returns how many they are. order: for every row of the result the row it was.
uint64_t order_by_faces(TileSpheres& spheres, std::vector<uint64_t>& order);

struct TileVariants {
    std::vector<std::vector<Imath::V3d>> places; ///< of every variant, by row; variant 0 among them
    double scale = 1; ///< of the radii, at which all variants fit
};

/// The variants of a fluid: the first `shared` rows, all that reach through a face, stay, and the others are
/// equilibrated further from where they are, wholly inside the cuboid. This is exactly the fluid's distribution given
/// the shared spheres. Throws Cancelled.
TileVariants equilibrate_variants(const TileSpheres& spheres, uint64_t shared, uint32_t count,
                                  std::optional<uint64_t> sweeps, uint64_t seed,
                                  const std::function<void(uint32_t, double)>& step, const Progress& progress);

/// The variants of a jammed or parted packing: `count` copies of the inner spheres (rows from `shared`), of which all
/// but the first start from random places, are packed at once, wholly inside the cuboid, around one set of shared
/// spheres, which all of them push.
///
/// Shared spheres that stayed where the first packing has them would be pins to the others, and pinned packings jam
/// early (Brito, Parisi, Zamponi, Soft Matter 9, 8540, 2013); those that all variants may push settle where all fit.
/// For the same reason the spheres are compressed and let go several times. (Jammed variants come out much alike within
/// two diameters of the faces, where the boundary decides: of 4,000 equal spheres, 71 % of the centres of the first
/// diameter and 26 % of the second coincide to 0.2 radii, below that as many as by chance.) goal: the scale of the
/// radii that is enough; nothing: as large as it gets. Throws Cancelled.
TileVariants pack_variants(const TileSpheres& spheres, uint64_t shared, uint32_t count, std::optional<double> goal,
                           uint64_t seed, const TileStep& step, const Progress& progress);

} // namespace scree
