#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Finds the spheres near a place among spheres of very different sizes.
///
/// There is one level per factor of two of the radius. A level is a grid of cells as wide as its largest diameter,
/// stored as a hash table of its filled cells. So cost and memory depend neither on the extent nor on the ratio of
/// radii.
class SphereGrid {
public:
    struct Entry {
        Imath::V3d position{0};
        uint64_t cell = 0; ///< key of the cell
        uint64_t index = 0; ///< of the sphere
        float radius = 0;
    };

    /// Both spans have the same length. The grid keeps copies.
    SphereGrid(std::span<const Imath::V3d> positions, std::span<const float> radii);

    /// Levels go from small spheres to large ones; spheres of radius 0 have a level of their own, the first.
    size_t level_count() const { return levels_.size(); }
    /// Largest radius of the level.
    double level_radius(size_t level) const { return levels_[level].radius; }
    /// The level's spheres, sorted by cell, so that most neighbours are near each other in memory.
    std::span<const Entry> entries(size_t level) const { return levels_[level].entries; }

    /// Calls visit(entry) for every sphere of the level whose centre is within `reach` along each axis, and for some
    /// others; stops and returns false when visit returns false. For speed, `reach` should be at most twice the level's
    /// radius.
    template <class Visit>
    bool visit_near(size_t level, const Imath::V3d& place, double reach, const Visit& visit) const
    {
        const Level& grid = levels_[level];
        for (int axis = 0; axis < 3; ++axis)
            if (place[axis] + reach < grid.lo[axis] || place[axis] - reach > grid.hi[axis]) return true;
        uint64_t lo[3], hi[3];
        for (int axis = 0; axis < 3; ++axis) {
            lo[axis] = grid.coordinate(place[axis] - reach, axis);
            hi[axis] = grid.coordinate(place[axis] + reach, axis);
        }
        const uint64_t mask = grid.starts.size() - 2;
        for (uint64_t z = lo[2]; z <= hi[2]; ++z)
            for (uint64_t y = lo[1]; y <= hi[1]; ++y) {
                const uint64_t row = grid.row_key(y, z);
                for (uint64_t x = lo[0]; x <= hi[0];) {
                    // Cells along x have consecutive buckets: read all up to the end of the table at once.
                    const uint64_t first = row + x, bucket = first & mask;
                    const uint64_t more = std::min(hi[0] - x, mask - bucket);
                    x += more + 1;
                    if (!grid.may_hold(first, more)) continue;
                    const uint64_t end = grid.starts[bucket + more + 1];
                    for (uint64_t i = grid.starts[bucket]; i < end; ++i)
                        if (grid.entries[i].cell - first <= more && !visit(grid.entries[i])) return false;
                }
            }
        return true;
    }

private:
    struct Level {
        double radius = 0, cells_per_length = 1;
        Imath::V3d lo{0}, hi{0};
        uint64_t stride_y = 0, stride_z = 0; ///< step of the key per row and per layer; 0: the keys of rows are hashes
        std::vector<uint64_t> starts; ///< first entry of each bucket, and the end; 2^n buckets
        std::vector<Entry> entries; ///< sorted by bucket
        /// Only with hashed rows: the bit of a key (its low bits) is set when a cell of this key is filled.
        std::vector<uint64_t> filled;

        uint64_t coordinate(double x, int axis) const
        {
            // Cells outside of the level's bounds are empty; the clamp also keeps far places within 64 bits.
            const double clamped = std::clamp(x, lo[axis], hi[axis]);
            return static_cast<uint64_t>(std::min((clamped - lo[axis]) * cells_per_length, 4e18));
        }

        /// False only if the cells of keys first to first + more are all empty. Most cells are, and this table fits a
        /// fast cache.
        bool may_hold(uint64_t first, uint64_t more) const
        {
            if (filled.empty()) return true;
            const uint64_t mask = 64 * filled.size() - 1;
            for (uint64_t k = 0; k <= more; ++k) {
                const uint64_t bit = (first + k) & mask;
                if (filled[bit / 64] >> (bit % 64) & 1) return true;
            }
            return false;
        }

        /// The key of cell (0, y, z). The key of cell (x, y, z) is greater by x; its low bits are the cell's bucket.
        uint64_t row_key(uint64_t y, uint64_t z) const
        {
            // If there are enough buckets for all cells, no hash is needed, and neighbouring rows are close in memory.
            if (stride_y > 0) return y * stride_y + z * stride_z;
            uint64_t h = y * 0x9e3779b97f4a7c15u;
            h = (h ^ (h >> 32) ^ z) * 0xbf58476d1ce4e5b9u;
            h = (h ^ (h >> 29)) * 0x94d049bb133111ebu;
            return h ^ (h >> 31);
        }
    };

    static void build(Level& level);

    std::vector<Level> levels_;
};

} // namespace scree
