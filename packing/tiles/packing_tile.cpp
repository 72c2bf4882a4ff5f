#include "packing/tiles/packing_tile.h"

#include "packing/tiles/tile_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

double PackingTile::fraction() const
{
    double cubes = 0;
    for (const double r : radius) cubes += r * r * r;
    return 4 * std::numbers::pi / 3 * cubes / (size.x * size.y * size.z);
}

double PackingTile::mean_radius() const
{
    double sum = 0;
    for (const double r : radius) sum += r;
    return radius.empty() ? 0 : sum / static_cast<double>(radius.size());
}

double PackingTile::largest_radius() const { return radius.empty() ? 0 : *std::ranges::max_element(radius); }

namespace {

/// Of equal overlaps, takes the pair that comes first, so that the threads' order does not matter.
void take_larger(TileOverlap& a, const TileOverlap& b)
{
    const bool earlier = b.rows[0] != a.rows[0] ? b.rows[0] < a.rows[0] : b.rows[1] < a.rows[1];
    if (b.overlap > a.overlap || (b.overlap == a.overlap && earlier)) a = b;
}

} // namespace

TileOverlap largest_tile_overlap(const PackingTile& tile, size_t variant)
{
    constexpr uint64_t nobody = ~uint64_t{0};
    const TileOverlap start{-1, {nobody, nobody}};
    if (tile.rows() == 0) return {-1, {0, 0}};
    const std::vector<double> radius(tile.radius.begin(), tile.radius.end());
    const std::vector<Imath::V3d>& place = tile.variants[variant];
    const Imath::V3d& size = tile.size;
    TileCells cells(size, radius);
    cells.fill(place);
    const auto look = [&](const tbb::blocked_range<uint32_t>& range, TileOverlap most) {
        for (uint32_t i = range.begin(); i < range.end(); ++i)
            // Each pair once: from the smaller sphere's level, or within a level from the lower row.
            for (size_t level = cells.level_of(i); level < cells.level_count(); ++level) {
                const bool own = level == cells.level_of(i);
                const double margin =
                    std::clamp(-most.overlap, 0.0, 1.0) * std::max(radius[i], own ? cells.level_radius(level) : 0.0);
                int hits = 0;
                cells.visit_near(level, place[i], radius[i] + cells.level_radius(level) + margin,
                                 [&](uint32_t j, int x, int y, int z) {
                                     if (own && (j < i || (j == i && x == 0 && y == 0 && z == 0))) return true;
                                     const Imath::V3d d =
                                         place[j] + Imath::V3d(x * size.x, y * size.y, z * size.z) - place[i];
                                     const double least = std::min(radius[i], radius[j]), sum = radius[i] + radius[j];
                                     const double reach = sum + std::clamp(-most.overlap, 0.0, 1.0) * least;
                                     if (d.length2() > reach * reach) return true;
                                     take_larger(most, {(sum - d.length()) / least, {std::min(i, j), std::max(i, j)}});
                                     // A sphere overlaps so many others only if the radii are wrong; then not all pairs
                                     // need to be seen.
                                     return ++hits < 200;
                                 });
            }
        return most;
    };
    TileOverlap most = tbb::parallel_reduce(tbb::blocked_range<uint32_t>(0, static_cast<uint32_t>(tile.rows()), 256),
                                            start, look, [](TileOverlap a, const TileOverlap& b) {
                                                take_larger(a, b);
                                                return a;
                                            });
    if (most.rows[0] == nobody) most.rows[0] = most.rows[1] = 0;
    return most;
}

} // namespace scree
