#pragma once

#include "render/bench/bench_result.h"

#include <string>

namespace scree {

// What a result is called, the same in the terminal and on the page.

/// "0.83 % (0.71 to 0.94)", or "not measured (< 0.4 %)" where it is no more than chance brings.
std::string bias_words(const Measured& squared_bias);
/// "+0.31 +- 0.12 %" of a channel.
std::string color_words(const Measured& color);
/// "+0.31 -0.02 +0.10 +- 0.12" per cent of red, green and blue, with the largest of their standard errors.
std::string colors_words(const std::array<Measured, 3>& colors);
/// The relative error in per cent, and where the reference itself is no better: "< 1.3 % (the reference's noise)".
std::string error_words(const ErrorEstimate& estimate);
/// "1.3 %" of a squared number.
std::string root_words(double squared);
/// Short numbers: "1.23 M", "45.6 k".
std::string count_words(double number);
std::string seconds_words(double seconds);
std::string bytes_words(uint64_t bytes);
/// Per second of processors.
double rate(uint64_t number, const MethodResult& method);
/// "Xeon ..., 2 cores, 2026-11-22".
std::string machine_words(const Machine& machine);

} // namespace scree
