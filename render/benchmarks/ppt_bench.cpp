// Proxy path tracing against explicit path tracing on packed beds under sun and sky: time x variance of a pixel.
//
// A path through explicit smooth glass cannot sample the sun: the path hits the sun by chance, or brings nothing. The
// variance is then the sun's radiance times the mean, and measuring it would take too many paths. So it is measured
// under a sun of ten times the diameter and a hundredth of the radiance, and multiplied by 100.
// usage: ppt_bench [GSDF error, default 0.02]

#include "base/warp.h"
#include "tests/builders/grain_beds.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

namespace {

using namespace scree;

struct Cost {
    double seconds = 0; // of one path
    double variance = 0; // of one path of a pixel
    double mean = 0;
};

/// Many paths along each of a few rays, so that the variance is that within a pixel; one thread.
Cost measure(const TestScene& bed, uint32_t explicit_grains, double seconds)
{
    PathOptions options;
    options.explicit_grains = explicit_grains;
    constexpr uint32_t rays = 48;
    std::vector<Estimate> pixels(rays);
    uint64_t paths = 0;
    const auto start = std::chrono::steady_clock::now();
    double spent = 0;
    for (uint32_t round = 0; spent < seconds; ++round) {
        for (uint32_t ray = 0; ray < rays; ++ray) {
            Sampler place(7, ray, 0, 0);
            const double u1 = place.next(), u2 = place.next();
            const V3d o(1.2, -2.2, 1.8), target = 0.7 * V3d(u1 - 0.5, u2 - 0.5, 0.6);
            for (uint32_t i = 0; i < 8; ++i, ++paths) {
                Sampler sampler(8, ray, round, i);
                pixels[ray].add(luminance(
                    trace_path(bed.world(), bed.tracer(), o, (target - o).normalized(), sampler, options).radiance));
            }
        }
        spent = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    Cost cost{spent / static_cast<double>(paths), 0, 0};
    for (const Estimate& pixel : pixels) {
        cost.variance += pixel.standard_error() * pixel.standard_error() * static_cast<double>(pixel.count()) / rays;
        cost.mean += pixel.mean() / rays;
    }
    return cost;
}

} // namespace

int main(int argc, char** argv)
{
    const double error = argc > 1 ? std::atof(argv[1]) : 0.02;
    flush_subnormals();
    fmt::print("beds of 10,000 grains, f 0.6, under a sun of 0.53 degrees and a sky; time x variance of EPT over that "
               "of PPT (larger is better)\n");
    fmt::print("{:20} {:>10} {:>10} {:>10} {:>10} {:>12} {:>14}\n", "grains", "EPT us", "PPT us", "EPT var", "PPT var",
               "EPT/PPT", "1 explicit");
    for (const BedGrain& grain : bed_grains(error)) {
        const bool by_chance = grain.material.is_delta();
        const auto bed = make_bed_under_sun(grain, 0.6, 10000, 0.53), hazy = make_bed_under_sun(grain, 0.6, 10000, 5.3);
        Cost ept, ppt, first;
        for (int turn = 0; turn < 2; ++turn) { // in turns; the second counts
            ept = measure(by_chance ? *hazy : *bed, all_grains, 5);
            ppt = measure(*bed, 0, 3);
            first = measure(by_chance ? *hazy : *bed, 1, 3);
        }
        if (by_chance) {
            ept.variance *= 100;
            first.variance *= 100;
        }
        const double base = ept.seconds * ept.variance;
        fmt::print("{:20} {:10.2f} {:10.2f} {:10.3g} {:10.3g} {:12.1f} {:14.1f}\n", grain.name, 1e6 * ept.seconds,
                   1e6 * ppt.seconds, ept.variance, ppt.variance, base / (ppt.seconds * ppt.variance),
                   base / (first.seconds * first.variance));
        std::fflush(stdout);
    }
    return 0;
}
