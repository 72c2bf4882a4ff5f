#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace scree {

/// Spheres in a periodic cuboid while a packing is made: what the steps of the tile generator hand on.
///
/// Several variants of a packing can be there at once: spheres of different sheets do not see each other, those of
/// sheet 0 are in every variant, and those of other sheets must lie wholly inside the cuboid, whose faces are walls to
/// them.
struct TileSpheres {
    Imath::V3d size{1};
    std::vector<double> radius;
    std::vector<Imath::V3d> place; ///< 0 <= x < size
    std::vector<uint32_t> sheet; ///< empty: one packing, all of sheet 0

    uint64_t count() const { return radius.size(); }
    uint32_t sheet_of(uint64_t i) const { return sheet.empty() ? 0 : sheet[i]; }
    /// Whether the two are in one variant.
    bool meet(uint64_t i, uint64_t j) const
    {
        return sheet.empty() || sheet[i] == sheet[j] || sheet[i] == 0 || sheet[j] == 0;
    }
    double mean_radius() const;
    double largest_radius() const;
    /// Volume of the spheres, of all sheets, over that of the cuboid.
    double fraction() const;
};

/// The cube root, whose digits do not change with factors of 8 (those of std::cbrt may, by one): a cuboid twice as wide
/// gives the same tile.
double cube_root(double x);

/// The image of a place in the cuboid, 0 <= x < size.
Imath::V3d wrapped_into(const Imath::V3d& place, const Imath::V3d& size);

/// How much all radii can be scaled (at most `most`) so that no two spheres come nearer than `gap` (an absolute
/// length), images included, nor a sphere that must be inside nearer to a face. rows: of the pair that decides, twice
/// the same for a face.
struct FittingScale {
    double scale;
    uint64_t rows[2] = {0, 0};
};
FittingScale fitting_scale(const TileSpheres& spheres, double gap, double most);

} // namespace scree
