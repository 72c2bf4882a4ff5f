#include "packing/tiles/tile_variants.h"

#include "packing/tiles/tile_jamming.h"
#include "packing/tiles/tile_random.h"
#include "packing/tiles/tile_sizes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

constexpr uint64_t variant_stream = 0x76617269616e74;
// A sphere touches a face if it is nearer than this, in radii.
constexpr double nearly = 1e-5;
// Number of compressions, and how far each goes beyond the first packing's fraction. With 5,000 equal spheres in 4
// variants, and the first one jammed at 0.644, one compression gave 0.632, two gave 0.633 and three 0.634.
constexpr int rounds = 3;
constexpr double overfull = 1.3;

uint64_t seed_of(uint32_t variant, uint64_t seed) { return hash_index(variant, seed, variant_stream); }

/// Stacks all variants as sheets of one system; inner spheres start at random places, except in the first variant.
TileSpheres stack_sheets(const TileSpheres& first, uint64_t shared, uint32_t count, uint64_t seed)
{
    TileSpheres all;
    all.size = first.size;
    const auto add = [&](uint64_t row, const Imath::V3d& place, uint32_t sheet) {
        all.radius.push_back(first.radius[row]);
        all.place.push_back(place);
        all.sheet.push_back(sheet);
    };
    for (uint64_t row = 0; row < shared; ++row) add(row, first.place[row], 0);
    for (uint32_t v = 0; v < count; ++v) {
        TileRandom random(seed_of(v, seed), variant_stream);
        for (uint64_t row = shared; row < first.count(); ++row) {
            const double r = first.radius[row];
            const Imath::V3d inside = Imath::V3d(r) + random.cube() * (first.size - Imath::V3d(2 * r));
            add(row, v == 0 ? first.place[row] : inside, v + 1);
        }
    }
    return all;
}

} // namespace

uint64_t order_by_faces(TileSpheres& spheres, std::vector<uint64_t>& order)
{
    const auto reaches = [&](uint64_t i) {
        const Imath::V3d &p = spheres.place[i], &size = spheres.size;
        const double reach = spheres.radius[i] * (1 + nearly);
        return std::min({p.x, p.y, p.z, size.x - p.x, size.y - p.y, size.z - p.z}) <= reach;
    };
    order.resize(spheres.count());
    for (uint64_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto inner = std::ranges::stable_partition(order, reaches);
    TileSpheres ordered = spheres;
    for (uint64_t row = 0; row < order.size(); ++row) {
        ordered.radius[row] = spheres.radius[order[row]];
        ordered.place[row] = spheres.place[order[row]];
    }
    spheres = std::move(ordered);
    return order.size() - inner.size();
}

TileVariants equilibrate_variants(const TileSpheres& spheres, uint64_t shared, uint32_t count,
                                  std::optional<uint64_t> sweeps, uint64_t seed,
                                  const std::function<void(uint32_t, double)>& step, const Progress& progress)
{
    TileVariants result;
    result.places.assign(count, spheres.place);
    tbb::parallel_for(uint32_t{1}, count, [&](uint32_t v) {
        TileSpheres fluid = spheres;
        equilibrate_spheres(
            fluid, shared, sweeps, seed_of(v, seed), [&](double part) { step(v, part); }, progress);
        result.places[v] = std::move(fluid.place);
    });
    return result;
}

TileVariants pack_variants(const TileSpheres& spheres, uint64_t shared, uint32_t count, std::optional<double> goal,
                           uint64_t seed, const TileStep& step, const Progress& progress)
{
    TileSpheres all = stack_sheets(spheres, shared, count, seed);
    // `overfull` is relative to one variant's fraction; all.fraction() counts the spheres of all variants.
    const double densest = overfull * std::max(spheres.fraction(), random_close_packing(spheres.radius)) *
                           all.fraction() / spheres.fraction();
    TileVariants result;
    result.scale = 0;
    std::vector<Imath::V3d> best;
    const auto keep_best = [&](double scale) {
        if (scale <= result.scale) return;
        result.scale = scale;
        best = all.place;
    };
    if (goal) keep_best(settle_spheres(all, *goal, step, progress));
    if (!goal || result.scale < *goal) keep_best(jam_spheres(all, densest, rounds, step, progress));
    if (goal) result.scale = std::min(result.scale, *goal);

    const uint64_t inner = spheres.count() - shared;
    for (uint32_t v = 0; v < count; ++v) {
        auto& places = result.places.emplace_back(best.begin(), best.begin() + static_cast<int64_t>(shared));
        const auto begin = best.begin() + static_cast<int64_t>(shared + v * inner);
        places.insert(places.end(), begin, begin + static_cast<int64_t>(inner));
    }
    return result;
}

} // namespace scree
