// The cost of a procedural fill by the number of its grains, beside a list of the same spheres.
// usage: fill_bench [--quick]

#include "mixtures/single_mixture.h"
#include "packing/fill/list_fill.h"
#include "packing/tiles/tile_generator.h"
#include "render/integrators/path_tracer.h"
#include "tests/builders/shapes.h"

#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <fstream>

namespace scree {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Resident memory of this process in MB.
double resident()
{
    std::ifstream statm("/proc/self/statm");
    uint64_t pages = 0;
    statm >> pages >> pages;
    return static_cast<double>(pages) * 4096 / 1e6;
}

Material clay()
{
    Material material;
    material.kind = MaterialKind::lambert;
    material.reflectance = Color(0.5f);
    return material;
}

void add_type_and_sky(World& world)
{
    world.types.push_back({"clay", clay(), nullptr});
    Light sky;
    sky.kind = LightKind::constant;
    sky.radiance = Color(1);
    world.lights = LightSet({sky}, 1.0);
}

World fill_world(const std::shared_ptr<const Domain>& domain, const std::shared_ptr<const PackingTile>& tile,
                 double radius)
{
    World world;
    const auto fill = std::make_shared<const ProceduralFill>(domain, tile, FillOptions{radius, 0});
    world.fill = std::make_shared<GrainFill>(fill, std::make_shared<SingleMixture>(0), world.space);
    world.domain = domain->bounds();
    add_type_and_sky(world);
    return world;
}

World listed_world(const ProceduralFill& fill)
{
    World world;
    list_fill(fill, uint64_t{1} << 40,
              [&](const ParticleFrame& frame) {
                  for (size_t i = 0; i < frame.size(); ++i) {
                      const V3f p(frame.position[i]);
                      world.grains.spheres.push_back({p.x, p.y, p.z, frame.radius[i]});
                      world.grains.ids.push_back(frame.id[i]);
                  }
              },
              {});
    world.grains.type_codes.assign(world.grains.spheres.size(), 0);
    world.grains.analytic_count = world.grains.size();
    world.grains.spheres.push_back({});
    world.grains.widen();
    world.domain = fill.domain().bounds();
    add_type_and_sky(world);
    return world;
}

struct Cost {
    double first = 0; ///< microseconds a ray from outside to its first hit
    double segment = 0; ///< microseconds a segment of a path among the grains
    double segments = 0; ///< a path
    double radiance = 0;
};

/// Parallel rays at a ball of radius 1 from random sides, one thread.
Cost walk(const World& world, const Tracer& tracer, uint32_t rays)
{
    Cost cost;
    std::vector<std::pair<V3d, V3d>> starts;
    for (uint32_t i = 0; i < rays; ++i) {
        Sampler sampler(1, i, 0, 0);
        const double z = 2 * sampler.next() - 1, phi = 2 * pi * sampler.next(), s = std::sqrt(1 - z * z);
        const Frame frame(V3d(s * std::cos(phi), s * std::sin(phi), z));
        const double r = 0.9 * std::sqrt(sampler.next()), a = 2 * pi * sampler.next();
        starts.emplace_back(frame.to_world({r * std::cos(a), r * std::sin(a), -1.5}), frame.n);
    }
    auto start = Clock::now();
    uint64_t hits = 0;
    for (const auto& [o, d] : starts) hits += tracer.intersect(o, d, {}).place.kind == HitKind::grain;
    cost.first = 1e6 * seconds_since(start) / rays;
    if (hits < rays / 2) fmt::print("few hits: nothing was measured\n");
    start = Clock::now();
    uint64_t segments = 0;
    for (uint32_t i = 0; i < rays; ++i) {
        Sampler sampler(2, i, 0, 0);
        const PathResult path = trace_path(world, tracer, starts[i].first, starts[i].second, sampler);
        segments += path.segments;
        cost.radiance += double{path.radiance.x} / rays;
    }
    cost.segment = 1e6 * seconds_since(start) / static_cast<double>(segments);
    cost.segments = static_cast<double>(segments) / rays;
    return cost;
}

std::shared_ptr<const PackingTile> tile_of(double fraction)
{
    TileOptions options;
    options.fraction = fraction;
    options.variants = 2;
    return std::make_shared<PackingTile>(make_tile(std::vector<double>(2000, 1.0), options, {}).tile);
}

void run(bool quick)
{
    const auto device = std::make_shared<EmbreeDevice>();
    const auto domain = std::make_shared<const Domain>(icosphere(5), "ball");
    const uint32_t rays = quick ? 20000 : 100000;
    fmt::print("A ball filled from a tile of 2,000 spheres in two variants, traced on one thread; paths among diffuse "
               "grains of\n"
               "reflectance 0.5 under a white sky. Times in microseconds; list: a list of the same spheres, if they "
               "are few enough.\n\n");
    fmt::print("{:>8} {:>10} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>10} {:>10} {:>8}\n", "fraction", "grains",
               "set-up s", "resident", "first hit", "segment", "segments", "radiance", "list: hit", "segment", "ratio");
    for (const double fraction : {0.05, 0.5}) {
        const auto tile = tile_of(fraction);
        for (const double count : {1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9}) {
            const double radius = std::cbrt(fraction / count);
            const auto start = Clock::now();
            const World world = fill_world(domain, tile, radius);
            const Tracer tracer(device, world);
            const double setup = seconds_since(start);
            const Cost cost = walk(world, tracer, rays);
            fmt::print("{:8} {:10.2e} {:8.2f} {:6.0f} MB {:9.2f} {:9.2f} {:9.1f} {:9.4f}", fraction,
                       world.fill->fill().expected_count(), setup, resident(), cost.first, cost.segment, cost.segments,
                       cost.radiance);
            if (count <= (quick ? 1e5 : 1e6)) {
                const World list = listed_world(world.fill->fill());
                const Tracer list_tracer(device, list);
                const Cost listed = walk(list, list_tracer, rays);
                fmt::print(" {:10.2f} {:10.2f} {:8.2f}", listed.first, listed.segment, cost.segment / listed.segment);
                if (listed.radiance != cost.radiance) fmt::print("  radiance differs: {}", listed.radiance);
            }
            fmt::print("\n");
        }
    }
}

} // namespace
} // namespace scree

int main(int argc, char** argv)
{
    scree::run(argc > 1 && std::strcmp(argv[1], "--quick") == 0);
    return 0;
}
