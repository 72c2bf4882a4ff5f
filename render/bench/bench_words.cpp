#include "render/bench/bench_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

namespace {

/// Two digits of a squared number's root, in per cent.
std::string percent(double squared)
{
    const double value = 100 * std::sqrt(std::max(0.0, squared));
    return value >= 99.5 ? fmt::format("{:.0f}", value) : fmt::format("{:.2g}", value);
}

} // namespace

std::string root_words(double squared) { return percent(squared) + " %"; }

std::string bias_words(const Measured& squared_bias)
{
    if (!std::isfinite(squared_bias.error)) return "not measured (nor is the reference's noise)";
    if (!squared_bias.is_above_zero()) return fmt::format("not measured (< {} %)", percent(std::max(0.0, squared_bias.value) + 1.96 * squared_bias.error));
    return fmt::format("{} % ({} to {})", percent(squared_bias.value), percent(squared_bias.low()), percent(squared_bias.high()));
}

std::string color_words(const Measured& color) { return fmt::format("{:+.2f} +- {:.2f} %", 100 * color.value, 100 * color.error); }

std::string colors_words(const std::array<Measured, 3>& c)
{
    return fmt::format("{:+.2f} {:+.2f} {:+.2f} +- {:.2f}", 100 * c[0].value, 100 * c[1].value, 100 * c[2].value, 100 * std::max({c[0].error, c[1].error, c[2].error}));
}

std::string error_words(const ErrorEstimate& estimate)
{
    if (estimate.is_below_reference()) return fmt::format("< {} (reference)", root_words(estimate.reference_noise.value));
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
    return seconds >= 1000 ? fmt::format("{:.0f} s", seconds) : seconds >= 0.0095 ? fmt::format("{:.3g} s", seconds) : fmt::format("{:.2g} ms", 1000 * seconds);
}

std::string bytes_words(uint64_t bytes) { return fmt::format("{:.1f} MB", 1e-6 * static_cast<double>(bytes)); }

double rate(uint64_t number, const MethodResult& method) { return method.time.processor > 0 ? static_cast<double>(number) / method.time.processor : 0; }

std::string machine_words(const Machine& machine)
{
    const auto counted = [](int n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); };
    return fmt::format("{}, {} on {}, {}", machine.processor, counted(machine.threads, "thread"), counted(machine.cores, "core"), machine.date);
}

} // namespace scree
