// Times and qualities of generated tiles, and of two neighbour searches: the cell grid and CGAL's periodic
// triangulation.
//
//   tile_bench [N ...]        (default 1000 10000; each N for every distribution)
#include "packing/report/bond_order.h"
#include "packing/report/near_pairs.h"
#include "packing/report/packed_spheres.h"
#include "packing/tiles/tile_cells.h"
#include "packing/tiles/tile_generator.h"
#include "packing/tiles/tile_random.h"
#include "packing/tiles/tile_sizes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Periodic_3_Delaunay_triangulation_3.h>
#include <CGAL/Periodic_3_Delaunay_triangulation_traits_3.h>
#include <CGAL/Periodic_3_regular_triangulation_3.h>
#include <CGAL/Periodic_3_regular_triangulation_traits_3.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

using namespace scree;

namespace {

double seconds_of(const auto& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void bench_tile(const std::string& name, const std::vector<std::string>& words, uint64_t count,
                std::optional<double> fraction, uint32_t variants)
{
    TileOptions options;
    options.fraction = fraction;
    options.variants = variants;
    options.seed = 1;
    MadeTile made;
    const double seconds =
        seconds_of([&] { made = make_tile(draw_tile_radii(parse_tile_sizes(words), count, 1), options, {}); });
    double worst = -1, contacts = 0, q6 = 0, local = 0, crystal = 0;
    uint64_t rattlers = 0;
    for (size_t v = 0; v < variants; ++v) {
        worst = std::max(worst, largest_tile_overlap(made.tile, v).overlap);
        const PackedSpheres packed(tile_frame(made.tile, v), name);
        const NearPairs pairs = measure_near_pairs(packed);
        const BondOrder order = measure_bond_order(packed, static_cast<double>(count) / packed.volume());
        contacts += pairs.mean_contacts_without_rattlers / variants;
        rattlers += pairs.rattlers;
        q6 = std::max(q6, order.global_q6);
        local += order.mean_local_q6 / variants;
        crystal = std::max(crystal, order.crystal_fraction);
    }
    fmt::print(
        "{:>7} {:<28} {:>8} {:>8} {:>8.1f} {:>9.5f} {:>10.1e} {:>6.2f} {:>6.1f} % {:>8.4f} {:>7.3f} {:>6.2f} %\n",
        count, name, fraction ? fmt::format("{}", *fraction) : "max", variants, seconds, made.tile.fraction(), worst,
        contacts, 100.0 * static_cast<double>(rattlers) / static_cast<double>(count * variants), q6, local,
        100 * crystal);
    std::fflush(stdout);
}

/// Times the search for pairs nearer than 1.2 sums of radii with the grid, and a triangulation, whose edges would have
/// to be filtered for such pairs.
void bench_neighbours(uint64_t count, double sigma)
{
    TileOptions options;
    options.fraction = 0.55;
    options.variants = 1;
    const std::vector<std::string> words = sigma > 0
                                               ? std::vector<std::string>{"lognormal", fmt::format("sigma={}", sigma)}
                                               : std::vector<std::string>{"mono"};
    const PackingTile tile = make_tile(draw_tile_radii(parse_tile_sizes(words), count, 1), options, {}).tile;
    const std::vector<Imath::V3d>& place = tile.variants[0];
    const std::vector<double> radius(tile.radius.begin(), tile.radius.end());
    uint64_t pairs = 0, edges = 0;
    double grid = 1e30;
    for (int k = 0; k < 3; ++k)
        grid = std::min(grid, seconds_of([&] {
                            pairs = 0;
                            TileCells cells(tile.size, radius);
                            cells.fill(place);
                            for (uint32_t i = 0; i < count; ++i)
                                for (size_t level = cells.level_of(i); level < cells.level_count(); ++level)
                                    cells.visit_near(level, place[i], 1.2 * (radius[i] + cells.level_radius(level)),
                                                     [&](uint32_t j, int x, int y, int z) {
                                                         if (level == cells.level_of(i) && j <= i) return true;
                                                         const double reach = 1.2 * (radius[i] + radius[j]);
                                                         pairs +=
                                                             (place[j] + Imath::V3d(x, y, z) - place[i]).length2() <
                                                             reach * reach;
                                                         return true;
                                                     });
                        }));
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    double cgal = 0;
    if (sigma > 0) {
        using Traits = CGAL::Periodic_3_regular_triangulation_traits_3<Kernel>;
        using Triangulation = CGAL::Periodic_3_regular_triangulation_3<Traits>;
        std::vector<Triangulation::Weighted_point> points;
        for (uint64_t i = 0; i < count; ++i)
            points.emplace_back(Triangulation::Bare_point(place[i].x, place[i].y, place[i].z), radius[i] * radius[i]);
        cgal = seconds_of([&] {
            const Triangulation triangulation(points.begin(), points.end(),
                                              Triangulation::Iso_cuboid(0, 0, 0, 1, 1, 1));
            edges = triangulation.number_of_edges();
        });
    } else {
        using Traits = CGAL::Periodic_3_Delaunay_triangulation_traits_3<Kernel>;
        using Triangulation = CGAL::Periodic_3_Delaunay_triangulation_3<Traits>;
        std::vector<Triangulation::Point> points;
        for (const Imath::V3d& p : place) points.emplace_back(p.x, p.y, p.z);
        cgal = seconds_of([&] {
            Triangulation triangulation(Triangulation::Iso_cuboid(0, 0, 0, 1, 1, 1));
            triangulation.insert(points.begin(), points.end(), true);
            edges = triangulation.number_of_edges();
        });
    }
    fmt::print("{:>7} {:<28} {:>12.4f} {:>9} {:>14.3f} {:>9} {:>9.0f}\n", count,
               fmt::format("{}", fmt::join(words, " ")), grid, pairs, cgal, edges, cgal / grid);
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
    std::vector<uint64_t> counts;
    for (int i = 1; i < argc; ++i) counts.push_back(std::strtoull(argv[i], nullptr, 10));
    if (counts.empty()) counts = {1000, 10000};

    fmt::print("neighbour search, one thread: pairs nearer than 1.2 sums of radii by the cell grid; all edges of "
               "CGAL's periodic\n"
               "Delaunay (equal radii) or regular triangulation\n{:>7} {:<28} {:>12} {:>9} {:>14} {:>9} {:>9}\n",
               "spheres", "radii", "grid s", "pairs", "triangulate s", "edges", "ratio");
    for (const uint64_t count : counts)
        for (const double sigma : {0.0, 0.3}) bench_neighbours(count, sigma);

    fmt::print(
        "\ntiles, all threads: the worst of the variants for overlap (negative: gap), Q6 and crystal, else their mean\n"
        "{:>7} {:<28} {:>8} {:>8} {:>8} {:>9} {:>10} {:>6} {:>8} {:>8} {:>7} {:>8}\n",
        "spheres", "radii", "fraction", "variants", "seconds", "reached", "overlap", "z", "rattlers", "Q6", "local",
        "crystal");
    for (const uint64_t count : counts) {
        for (const uint32_t variants : {1u, 4u}) {
            bench_tile("mono", {"mono"}, count, {}, variants);
            bench_tile("bidisperse 1:1.4", {"bidisperse"}, count, {}, variants);
            bench_tile("lognormal 0.3", {"lognormal"}, count, {}, variants);
        }
        bench_tile("power r^-3, ratio 10", {"power"}, count, {}, 1);
        bench_tile("mono", {"mono"}, count, 0.3, 4);
        bench_tile("mono", {"mono"}, count, 0.49, 4);
        bench_tile("mono", {"mono"}, count, 0.6, 4);
    }
    return 0;
}
