#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <vector>

namespace scree {

/// Spheres in a periodic cuboid while a packing is made: the data that the tile generator's steps exchange.
///
/// It can hold several variants of a packing at once. Spheres of sheet 0 are in every variant. Spheres of different
/// other sheets ignore each other; they must lie wholly inside the cuboid, whose faces are walls for them.
struct TileSpheres {
    Imath::V3d size{1};
    std::vector<double> radius;
    std::vector<Imath::V3d> place; ///< 0 <= x < size
    std::vector<uint32_t> sheet; ///< empty: one packing, all spheres in sheet 0

    uint64_t count() const { return radius.size(); }
    uint32_t sheet_of(uint64_t i) const { return sheet.empty() ? 0 : sheet[i]; }
    /// Whether some variant contains both spheres.
    bool meet(uint64_t i, uint64_t j) const
    {
        return sheet.empty() || sheet[i] == sheet[j] || sheet[i] == 0 || sheet[j] == 0;
    }
    double mean_radius() const;
    double largest_radius() const;
    /// Volume of the spheres of all sheets over that of the cuboid.
    double fraction() const;
};

/// The cube root, with digits that do not change with factors of 8 (the last digit of std::cbrt may): a cuboid twice as
/// wide gives the same tile.
double cube_root(double x);

/// The periodic image of a place that lies in the cuboid, 0 <= x < size.
Imath::V3d wrapped_into(const Imath::V3d& place, const Imath::V3d& size);

/// The largest factor for all radii (at most `most`) at which no two spheres, images included, come nearer than `gap`
/// (an absolute length), and no sphere that must stay inside comes nearer than that to a face. rows: the pair that
/// limits the factor; twice the same row for a face.
struct FittingScale {
    double scale;
    uint64_t rows[2] = {0, 0};
};
FittingScale fitting_scale(const TileSpheres& spheres, double gap, double most);

} // namespace scree
