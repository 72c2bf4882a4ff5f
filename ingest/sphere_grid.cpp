#include "ingest/sphere_grid.h"

#include <bit>
#include <limits>
#include <map>

namespace scree {

namespace {

/// Number of a radius' level, which grows with the radius.
int level_number(double radius, double largest)
{
    if (!(radius > 0)) return std::numeric_limits<int>::min();
    int halvings = 0;
    // The limits are not at exact halves of the largest radius: radii often go from R to 2 R, and those should share a
    // level.
    std::frexp(0.75 * largest / radius, &halvings);
    return -std::max(halvings, 0);
}

} // namespace

SphereGrid::SphereGrid(std::span<const Imath::V3d> positions, std::span<const float> radii)
{
    double largest = 0;
    for (const float radius : radii) largest = std::max(largest, static_cast<double>(radius));
    std::map<int, size_t> counts;
    for (const float radius : radii) ++counts[level_number(radius, largest)];
    std::map<int, size_t> level_of_number;
    for (const auto& [number, count] : counts) {
        level_of_number[number] = levels_.size();
        levels_.emplace_back().entries.reserve(count);
    }
    for (size_t i = 0; i < positions.size(); ++i)
        levels_[level_of_number[level_number(radii[i], largest)]].entries.push_back({positions[i], 0, i, radii[i]});
    for (Level& level : levels_) build(level);
}

void SphereGrid::build(Level& level)
{
    level.lo = level.hi = level.entries.front().position;
    for (const Entry& entry : level.entries) {
        level.radius = std::max(level.radius, static_cast<double>(entry.radius));
        for (int axis = 0; axis < 3; ++axis) {
            level.lo[axis] = std::min(level.lo[axis], entry.position[axis]);
            level.hi[axis] = std::max(level.hi[axis], entry.position[axis]);
        }
    }
    // Spheres of radius 0 need cells of some width too: about one sphere per cell if they are spread evenly.
    const Imath::V3d extent = level.hi - level.lo;
    const double widest = std::max({extent.x, extent.y, extent.z});
    const double width =
        level.radius > 0 ? 2 * level.radius : widest / std::cbrt(static_cast<double>(level.entries.size()));
    level.cells_per_length = std::isfinite(1 / width) ? 1 / width : 1;

    const uint64_t count = level.entries.size();
    const Imath::V3d cells = extent * level.cells_per_length + Imath::V3d(1);
    uint64_t buckets = std::bit_ceil(2 * count);
    if (cells.x * cells.y * cells.z < 8.0 * static_cast<double>(count)) {
        level.stride_y = level.coordinate(level.hi.x, 0) + 1;
        level.stride_z = level.stride_y * (level.coordinate(level.hi.y, 1) + 1);
        buckets = std::bit_ceil(level.stride_z * (level.coordinate(level.hi.z, 2) + 1));
    }
    const uint64_t mask = buckets - 1;
    const bool hashed = level.stride_y == 0;
    if (hashed) level.filled.assign(std::bit_ceil(16 * count + 48) / 64, 0); // about 16 bits per sphere
    level.starts.assign(buckets + 1, 0);
    for (Entry& entry : level.entries) {
        const Imath::V3d& p = entry.position;
        entry.cell = level.row_key(level.coordinate(p.y, 1), level.coordinate(p.z, 2)) + level.coordinate(p.x, 0);
        ++level.starts[(entry.cell & mask) + 1];
        const uint64_t bit = entry.cell & (64 * level.filled.size() - 1);
        if (hashed) level.filled[bit / 64] |= uint64_t{1} << (bit % 64);
    }
    for (size_t i = 1; i < level.starts.size(); ++i) level.starts[i] += level.starts[i - 1];
    // Counting sort by bucket; it is stable, so the entries of a bucket stay in the order of the spheres.
    std::vector<Entry> sorted(level.entries.size());
    std::vector<uint64_t> next(level.starts.begin(), level.starts.end() - 1);
    for (const Entry& entry : level.entries) sorted[next[entry.cell & mask]++] = entry;
    level.entries.swap(sorted);
}

} // namespace scree
