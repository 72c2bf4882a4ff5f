#include "packing/tiles/tile_cells.h"

#include "base/error.h"
#include "packing/tiles/tile_spheres.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace scree {

TileCells::TileCells(const Imath::V3d& size, std::span<const double> radii, double skin)
    : level_of_(radii.size()), next_(radii.size(), none), previous_(radii.size(), none), cell_(radii.size(), 0)
{
    if (radii.size() >= (uint64_t{1} << 27))
        throw InputError("tile", fmt::format("{} spheres", radii.size()), "fewer than 2^27",
                         "a tile repeats without end: thousands of spheres are enough");
    if (radii.empty()) return;
    const double largest = *std::ranges::max_element(radii);
    // Not at exact halves of the largest radius: radii often range from R to 2 R, and those should share a level.
    const auto number = [&](double radius) {
        int halvings = 0;
        std::frexp(0.75 * largest / radius, &halvings);
        return -std::clamp(halvings, 0, 60);
    };
    std::map<int, uint64_t> counts;
    for (const double radius : radii) ++counts[number(radius)];
    std::map<int, size_t> level_of_number;
    for (const auto& [n, count] : counts) {
        level_of_number[n] = levels_.size();
        levels_.emplace_back();
    }
    for (size_t i = 0; i < radii.size(); ++i) {
        level_of_[i] = static_cast<uint8_t>(level_of_number[number(radii[i])]);
        Level& level = levels_[level_of_[i]];
        level.radius = std::max(level.radius, radii[i]);
    }
    uint64_t cells = 0;
    for (const auto& [n, level_index] : level_of_number) {
        Level& level = levels_[level_index];
        // If the tile is dilute, cells hold about one sphere each.
        const double volume_of_one = size.x * size.y * size.z / static_cast<double>(counts[n]);
        const double width = std::max(2 * level.radius + skin, cube_root(volume_of_one));
        for (int axis = 0; axis < 3; ++axis) {
            level.cells[axis] = static_cast<int64_t>(std::clamp(size[axis] / width, 1.0, 1e6));
            level.cells_per_length[axis] = static_cast<double>(level.cells[axis]) / size[axis];
        }
        level.first = cells;
        cells += static_cast<uint64_t>(level.cells[0] * level.cells[1] * level.cells[2]);
    }
    heads_.assign(cells, none);
}

uint64_t TileCells::cell_of(uint32_t sphere, const Imath::V3d& place) const
{
    const Level& level = levels_[level_of_[sphere]];
    uint64_t c[3];
    for (int axis = 0; axis < 3; ++axis)
        c[axis] = static_cast<uint64_t>(
            std::clamp(static_cast<int64_t>(std::floor(place[axis] * level.cells_per_length[axis])), int64_t{0},
                       level.cells[axis] - 1));
    return level.first + (c[2] * static_cast<uint64_t>(level.cells[1]) + c[1]) * static_cast<uint64_t>(level.cells[0]) +
           c[0];
}

void TileCells::insert(uint32_t sphere, uint64_t cell)
{
    cell_[sphere] = cell;
    previous_[sphere] = none;
    next_[sphere] = heads_[cell];
    if (next_[sphere] != none) previous_[next_[sphere]] = sphere;
    heads_[cell] = sphere;
}

void TileCells::fill(std::span<const Imath::V3d> places)
{
    std::ranges::fill(heads_, none);
    for (size_t i = places.size(); i-- > 0;)
        insert(static_cast<uint32_t>(i), cell_of(static_cast<uint32_t>(i), places[i]));
}

void TileCells::move(uint32_t sphere, const Imath::V3d& place)
{
    const uint64_t cell = cell_of(sphere, place);
    if (cell == cell_[sphere]) return;
    const uint32_t before = previous_[sphere], after = next_[sphere];
    (before != none ? next_[before] : heads_[cell_[sphere]]) = after;
    if (after != none) previous_[after] = before;
    insert(sphere, cell);
}

} // namespace scree
