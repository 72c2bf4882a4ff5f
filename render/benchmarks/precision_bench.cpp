// How far apart two renders of the same scene are, pixel by pixel: the tracer in single precision (the default) against
// one built with -DSCREE_DOUBLE=ON. render/benchmarks/compare_precision runs it over scenes. The same seed gives the
// same paths, except where rounding flips a choice.
//
//     precision_bench NAME SINGLE.exr DOUBLE.exr
//
// Exit status 1 if the means are farther apart than rounding and chance explain.

#include "base/error.h"
#include "render/bench/exr_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

int main(int argc, char** argv)
try {
    if (argc != 4) {
        fmt::print(stderr, "precision_bench NAME SINGLE.exr DOUBLE.exr\n");
        return 2;
    }
    const scree::ExrPlanes single = scree::read_exr_planes(argv[2]), twice = scree::read_exr_planes(argv[3]);
    const size_t count = twice.planes.at("R").size();
    uint64_t differing = 0;
    double worst = 0, mean = 0, sum = 0, squares = 0;
    for (size_t i = 0; i < count; ++i) {
        double most = 0, difference = 0, value = 0;
        for (const char* channel : {"R", "G", "B"}) {
            const double a = single.planes.at(channel).at(i), b = twice.planes.at(channel)[i];
            if (a != b) most = std::max(most, std::abs(a - b) / std::max(std::abs(a), std::abs(b)));
            difference += (a - b) / 3;
            value += b / 3;
        }
        if (most > 1e-5) ++differing;
        worst = std::max(worst, most);
        mean += value;
        sum += difference;
        squares += difference * difference;
    }
    // Where rounding flips a choice, pixels differ by their noise, as often up as down: the standard error is that of
    // the pixels' differences.
    const auto n = static_cast<double>(count);
    const double error = std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n)) / n);
    const double off = sum / n, rounding = 1e-6 * mean / n, scale = mean != 0 ? 100 * n / mean : 1;
    const bool agree = std::abs(off) <= 4 * error + rounding && std::isfinite(mean);
    fmt::print("{:<44} {:>7.2f} % {:>10.2e} {:>14.8g} {:>+11.1e} % {:>8.1e} % {:>+7.1f}{}\n", argv[1],
               100 * static_cast<double>(differing) / n, worst, mean / n, off * scale, error * scale,
               error > 0 ? off / error : 0, agree ? "" : "  FAILED");
    return agree ? 0 : 1;
} catch (const scree::InputError& error) {
    fmt::print(stderr, "precision_bench: {}\n", error.what());
    return 2;
} catch (const std::exception& error) {
    fmt::print(stderr, "precision_bench: {}\n", error.what());
    return 1;
}
