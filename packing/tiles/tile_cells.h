#pragma once

#include <Imath/ImathVec.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Finds the spheres near a place in a periodic cuboid, while spheres move.
///
/// There is a level for every factor of two of the radius. A level is a periodic grid whose cells are at least as wide
/// as its largest diameter; each cell has a linked list of its spheres. So the cost does not depend on the range of
/// radii. (ingest/sphere_grid.h does the same for spheres at rest in open space.)
class TileCells {
public:
    static constexpr uint32_t none = 0xffffffffu;

    /// skin: how much wider than the largest diameter cells should be. Throws InputError above 2^27 spheres.
    TileCells(const Imath::V3d& size, std::span<const double> radii, double skin = 0);

    /// Enters all spheres; places in 0 <= x < size.
    void fill(std::span<const Imath::V3d> places);
    /// Updates the cell of a sphere that moved to `place`.
    void move(uint32_t sphere, const Imath::V3d& place);

    size_t level_count() const { return levels_.size(); }
    size_t level_of(uint32_t sphere) const { return level_of_[sphere]; }
    /// Largest radius of the level; levels go from small to large.
    double level_radius(size_t level) const { return levels_[level].radius; }

    /// Calls visit(sphere, x, y, z) for every sphere of the level that has an image within `reach` of the place along
    /// each axis, once for each such image, and for some others. x, y, z: the image's shift in edges of the cuboid.
    /// place: 0 <= x < size. Stops and returns false when visit returns false.
    template <class Visit>
    bool visit_near(size_t level, const Imath::V3d& place, double reach, const Visit& visit) const
    {
        const Level& grid = levels_[level];
        // Slightly larger, so that no sphere is missed by rounding of the cells' coordinates.
        int64_t lo[3], hi[3];
        for (int axis = 0; axis < 3; ++axis) {
            const double p = place[axis] * grid.cells_per_length[axis],
                         r = reach * grid.cells_per_length[axis] * (1 + 1e-12) + 1e-9;
            lo[axis] = static_cast<int64_t>(std::floor(p - r));
            hi[axis] = static_cast<int64_t>(std::floor(p + r));
        }
        Cursor z(lo[2], grid.cells[2]);
        for (int64_t k = lo[2]; k <= hi[2]; ++k, z.advance(grid.cells[2])) {
            Cursor y(lo[1], grid.cells[1]);
            for (int64_t j = lo[1]; j <= hi[1]; ++j, y.advance(grid.cells[1])) {
                const uint64_t row =
                    grid.first + (static_cast<uint64_t>(z.cell) * static_cast<uint64_t>(grid.cells[1]) +
                                  static_cast<uint64_t>(y.cell)) *
                                     static_cast<uint64_t>(grid.cells[0]);
                Cursor x(lo[0], grid.cells[0]);
                for (int64_t i = lo[0]; i <= hi[0]; ++i, x.advance(grid.cells[0]))
                    for (uint32_t s = heads_[row + static_cast<uint64_t>(x.cell)]; s != none; s = next_[s])
                        if (!visit(s, x.image, y.image, z.image)) return false;
            }
        }
        return true;
    }

private:
    struct Level {
        double radius = 0;
        int64_t cells[3] = {1, 1, 1};
        Imath::V3d cells_per_length{1};
        uint64_t first = 0; ///< its first cell among the cells of all levels
    };
    /// A cell of the endless lattice along an axis: the cell of the cuboid it repeats, and how many edges away.
    struct Cursor {
        int64_t cell;
        int image;
        Cursor(int64_t number, int64_t cells)
        {
            const int64_t floor = number >= 0 ? number / cells : -((cells - 1 - number) / cells);
            image = static_cast<int>(floor);
            cell = number - floor * cells;
        }
        void advance(int64_t cells)
        {
            if (++cell == cells) cell = 0, ++image;
        }
    };

    uint64_t cell_of(uint32_t sphere, const Imath::V3d& place) const;
    void insert(uint32_t sphere, uint64_t cell);

    std::vector<Level> levels_;
    std::vector<uint8_t> level_of_;
    std::vector<uint32_t> heads_, next_, previous_;
    std::vector<uint64_t> cell_;
};

} // namespace scree
