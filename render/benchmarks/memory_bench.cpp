// What a grain costs in memory: resident bytes of the grain store and of Embree's structure over it, measured as the
// growth of the process, for 10^5 to 10^7 spheres on a jittered lattice (Embree's own monitor counts its build memory
// twice).
//
// usage: memory_bench [largest count]

#include "base/hash.h"
#include "base/work_meter.h"
#include "render/trace/tracer.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <memory>

#include <malloc.h>

namespace scree {
namespace {

double used_bytes()
{
    malloc_trim(0);
    return static_cast<double>(resident_bytes());
}

void run(uint64_t count)
{
    const auto device = std::make_shared<EmbreeDevice>();
    const double before = used_bytes();
    World world;
    world.types.push_back({"grain", Material{}, nullptr});
    GrainStore& grains = world.grains;
    const auto edge = static_cast<uint64_t>(std::ceil(std::cbrt(static_cast<double>(count))));
    const double scale = 2.0 / static_cast<double>(edge);
    grains.spheres.reserve(count + 1);
    grains.type_codes.assign(count, 0);
    grains.analytic_count = static_cast<uint32_t>(count);
    for (uint64_t i = 0; i < count; ++i) {
        const auto place = [&](uint64_t cell, uint64_t axis) {
            return static_cast<float>((static_cast<double>(cell) + 0.1 * unit_double(hash_index(i, 1, axis))) * scale -
                                      1);
        };
        grains.spheres.push_back({place(i % edge, 0), place(i / edge % edge, 1), place(i / edge / edge, 2),
                                  static_cast<float>(0.45 * scale)});
    }
    grains.spheres.push_back({});
    const double stored = used_bytes();
    const auto start = std::chrono::steady_clock::now();
    const Tracer tracer(device, world);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const double built = used_bytes();
    const auto n = static_cast<double>(count);
    fmt::print("{:>10} {:>12.1f} {:>12.1f} {:>12.1f} {:>14.2f}\n", count, (stored - before) / n, (built - stored) / n,
               (built - before) / n, seconds);
}

} // namespace
} // namespace scree

int main(int argc, char** argv)
{
    const uint64_t largest = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10000000;
    fmt::print("resident bytes a grain\n{:>10} {:>12} {:>12} {:>12} {:>14}\n", "grains", "store", "Embree", "in all",
               "build seconds");
    for (uint64_t n = 100000; n <= largest; n *= 10) scree::run(n);
    return 0;
}
