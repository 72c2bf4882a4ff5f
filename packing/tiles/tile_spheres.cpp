#include "packing/tiles/tile_spheres.h"

#include "packing/tiles/tile_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace scree {

double TileSpheres::mean_radius() const
{
    return std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(count());
}

double TileSpheres::largest_radius() const { return *std::ranges::max_element(radius); }

double TileSpheres::fraction() const
{
    double cubes = 0;
    for (const double r : radius) cubes += r * r * r;
    return 4 * std::numbers::pi / 3 * cubes / (size.x * size.y * size.z);
}

double cube_root(double x)
{
    const int thirds = static_cast<int>(std::floor(std::ilogb(x) / 3.0));
    return std::ldexp(std::cbrt(std::ldexp(x, -3 * thirds)), thirds);
}

Imath::V3d wrapped_into(const Imath::V3d& place, const Imath::V3d& size)
{
    Imath::V3d result;
    for (int axis = 0; axis < 3; ++axis) {
        double x = place[axis] - std::floor(place[axis] / size[axis]) * size[axis];
        // Rounding can put x just outside 0 <= x < size, at either end.
        if (x < 0) x += size[axis];
        if (x >= size[axis]) x = 0;
        result[axis] = x;
    }
    return result;
}

namespace {

/// Of equal scales, takes the pair that comes first, so that the threads' order does not matter.
void take_smaller(FittingScale& a, const FittingScale& b)
{
    const bool earlier = b.rows[0] != a.rows[0] ? b.rows[0] < a.rows[0] : b.rows[1] < a.rows[1];
    if (b.scale < a.scale || (b.scale == a.scale && earlier)) a = b;
}

} // namespace

FittingScale fitting_scale(const TileSpheres& spheres, double gap, double most)
{
    const Imath::V3d& size = spheres.size;
    TileCells cells(size, spheres.radius);
    cells.fill(spheres.place);
    const auto look = [&](const tbb::blocked_range<uint32_t>& range, FittingScale least) {
        for (uint32_t i = range.begin(); i < range.end(); ++i) {
            const Imath::V3d p = spheres.place[i];
            const double r = spheres.radius[i];
            if (spheres.sheet_of(i) > 0)
                for (int axis = 0; axis < 3; ++axis)
                    take_smaller(least, {(std::min(p[axis], size[axis] - p[axis]) - gap) / r, {i, i}});
            // Each pair once: from the smaller sphere's level, or within a level from the lower row.
            for (size_t level = cells.level_of(i); level < cells.level_count(); ++level) {
                const bool own = level == cells.level_of(i);
                cells.visit_near(
                    level, p, most * (r + cells.level_radius(level)) + gap, [&](uint32_t j, int x, int y, int z) {
                        if (own && (j < i || (j == i && x == 0 && y == 0 && z == 0))) return true;
                        if (!spheres.meet(i, j)) return true;
                        const Imath::V3d d = spheres.place[j] + Imath::V3d(x * size.x, y * size.y, z * size.z) - p;
                        const double sum = r + spheres.radius[j], reach = most * sum + gap;
                        if (d.length2() >= reach * reach) return true;
                        take_smaller(least, {(d.length() - gap) / sum, {std::min(i, j), std::max(i, j)}});
                        return true;
                    });
            }
        }
        return least;
    };
    constexpr uint64_t nobody = ~uint64_t{0};
    const FittingScale start{most, {nobody, nobody}};
    FittingScale least =
        tbb::parallel_reduce(tbb::blocked_range<uint32_t>(0, static_cast<uint32_t>(spheres.count()), 256), start, look,
                             [](FittingScale a, const FittingScale& b) {
                                 take_smaller(a, b);
                                 return a;
                             });
    if (least.rows[0] == nobody) least.rows[0] = least.rows[1] = 0;
    return least;
}

} // namespace scree
