#include "render/bench/bench_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

/// The square root of a number in per cent, with two digits.
std::string percent(double squared)
{
    const double value = 100 * std::sqrt(std::max(0.0, squared));
    return value >= 99.5 ? fmt::format("{:.0f}", value) : fmt::format("{:.2g}", value);
}

} // namespace

std::string root_words(double squared) { return percent(squared) + " %"; }

std::string bias_words(const Measured& squared_bias)
{
    if (!std::isfinite(squared_bias.error)) return "not known";
    if (!squared_bias.is_above_zero())
        return fmt::format("< {} %", percent(std::max(squared_bias.high(), squared_bias.high() - squared_bias.value)));
    return fmt::format("{} % ({} to {})", percent(squared_bias.value), percent(squared_bias.low()),
                       percent(squared_bias.high()));
}

std::string colors_words(const std::array<Measured, 3>& c)
{
    const double error = 100 * std::max({c[0].error, c[1].error, c[2].error});
    return fmt::format("{:+.2f} {:+.2f} {:+.2f} +- {}", 100 * c[0].value, 100 * c[1].value, 100 * c[2].value,
                       std::isfinite(error) ? fmt::format("{:.2f}", error) : "?");
}

std::string error_words(const ErrorEstimate& estimate)
{
    if (estimate.is_below_reference()) return fmt::format("< {} (ref.)", root_words(estimate.reference_noise.value));
    if (!estimate.knows_reference()) return root_words(estimate.squared_error.value) + " (with ref.)";
    return root_words(estimate.squared_error.value);
}

std::string count_words(double number)
{
    if (number >= 1e9) return fmt::format("{:.3g} G", 1e-9 * number);
    if (number >= 1e6) return fmt::format("{:.3g} M", 1e-6 * number);
    if (number >= 1e4) return fmt::format("{:.3g} k", 1e-3 * number);
    return fmt::format("{:.3g}", number);
}

std::string seconds_words(double seconds)
{
    return seconds >= 1000     ? fmt::format("{:.0f} s", seconds)
           : seconds >= 0.0095 ? fmt::format("{:.3g} s", seconds)
                               : fmt::format("{:.2g} ms", 1000 * seconds);
}

std::string bytes_words(uint64_t bytes) { return fmt::format("{:.1f} MB", 1e-6 * static_cast<double>(bytes)); }

double rate(uint64_t number, const MethodResult& method)
{
    return method.time.processor > 0 ? static_cast<double>(number) / method.time.processor : 0;
}

std::string gain_words(const BenchResult& result, const MethodResult& method)
{
    const auto gain = result.gain(method);
    if (!gain) return "-";
    if (gain->error == 0) return "1";
    if (!std::isfinite(gain->error)) return fmt::format("{:.2g} +- ? x", gain->value);
    const int decimals =
        std::clamp(static_cast<int>(std::ceil(-std::log10(gain->error))), 0, 4); // one digit of the error
    return fmt::format("{:.{}f} +- {:.{}f} x", gain->value, decimals, gain->error, decimals);
}

std::string setup_words(const SetupTime& setup)
{
    return seconds_words(setup.all.processor) + (setup.cached.empty() ? "" : " (cache)");
}

std::string flip_words(const BenchResult& result, double flip)
{
    return fmt::format("{:.3f}{}", flip,
                       result.reference.picture.halved && flip <= result.reference_flip ? " (ref.)" : "");
}

std::string noise_words(const BenchResult& result)
{
    return std::isfinite(result.reference_noise.error) ? root_words(result.reference_noise.value) : "not known";
}

std::string scene_words(const BenchResult& result)
{
    const ReferencePicture& r = result.reference;
    const BenchJob& job = result.job;
    std::string text =
        fmt::format("{}, frame {}, {}x{}, {} seeds, seed {}, {:g} s a method. Reference: {}", job.scene.scene.string(),
                    job.frame, result.width(), result.height(), job.seeds, job.scene.options.seed, job.seconds, r.name);
    if (r.samples > 0)
        text +=
            fmt::format(", {} samples a pixel, {} of processor time", r.samples, seconds_words(r.processor_seconds));
    return text +
           fmt::format(", noise {}{}", noise_words(result),
                       r.picture.halved ? fmt::format(", FLIP between its halves {:.3f}", result.reference_flip) : "");
}

std::string machine_words(const Machine& machine, double processor_share)
{
    const auto counted = [](int n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); };
    return fmt::format("{}, {} on {}, {:.0f} % of a core per thread, {}; Scree {}, build {}", machine.processor,
                       counted(machine.threads, "thread"), counted(machine.cores, "core"), 100 * processor_share,
                       machine.date, SCREE_VERSION, machine.build);
}

} // namespace scree
