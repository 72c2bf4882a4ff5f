#pragma once

#include "packing/tiles/tile_generator.h"

namespace scree {

/// Moves the rows to the front whose spheres reach through (or nearly touch) a face of the cuboid, keeps the order
/// otherwise, and returns the number of these rows. order: the old row of each new row.
uint64_t order_by_faces(TileSpheres& spheres, std::vector<uint64_t>& order);

struct TileVariants {
    std::vector<std::vector<Imath::V3d>> places; ///< of every variant, by row; variant 0 among them
    double scale = 1; ///< of the radii, at which all variants fit
};

/// Makes the variants of a fluid: the first `shared` rows, which include all that reach through a face, stay; the
/// others are equilibrated further from their places, wholly inside the cuboid. This is exactly the fluid's
/// distribution given the shared spheres. Throws Cancelled.
TileVariants equilibrate_variants(const TileSpheres& spheres, uint64_t shared, uint32_t count,
                                  std::optional<uint64_t> sweeps, uint64_t seed,
                                  const std::function<void(uint32_t, double)>& step, const Progress& progress);

/// Makes the variants of a jammed or parted packing: `count` copies of the inner spheres (rows from `shared`) are
/// packed at once, wholly inside the cuboid, around one set of shared spheres, which all copies push. All copies but
/// the first start from random places.
///
/// If the shared spheres stayed where the first packing has them, they would act as pins for the others, and pinned
/// packings jam early (Brito, Parisi, Zamponi, Soft Matter 9, 8540, 2013). Shared spheres that all variants may push
/// settle where all fit. For the same reason the spheres are compressed and decompressed several times. (Jammed
/// variants are much alike within two diameters of the faces, where the boundary decides: of 4,000 equal spheres, 71 %
/// of the centres in the first diameter and 26 % of those in the second coincide to 0.2 radii; deeper, no more than by
/// chance.) goal: a sufficient scale of the radii; nothing: as large as possible. Throws Cancelled.
TileVariants pack_variants(const TileSpheres& spheres, uint64_t shared, uint32_t count, std::optional<double> goal,
                           uint64_t seed, const TileStep& step, const Progress& progress);

} // namespace scree
