#pragma once

#include "render/bench/bench_result.h"

#include <string>

namespace scree {

// What a result is called, the same in the terminal and on the page.

/// "0.83 % (0.71 to 0.94)", or "< 0.4 %" where it is no more than chance brings.
std::string bias_words(const Measured& squared_bias);
/// "+0.31 -0.02 +0.10 +- 0.12" per cent of red, green and blue, with the largest of their standard errors.
std::string colors_words(const std::array<Measured, 3>& colors);
/// The relative error in per cent, and where the reference itself is no better: "< 1.3 % (ref.)".
std::string error_words(const ErrorEstimate& estimate);
/// "1.3 %" of a squared number.
std::string root_words(double squared);
/// "2.5 +- 0.1 x": BenchResult::gain.
std::string gain_words(const BenchResult& result, const MethodResult& method);
/// Processor seconds, and whether part of it was read from a cache.
std::string setup_words(const SetupTime& setup);
/// A mean difference, marked where it is no more than that of the reference's halves.
std::string flip_words(const BenchResult& result, double flip);
/// Of the reference.
std::string noise_words(const BenchResult& result);
/// What was rendered for how long, with the reference.
std::string scene_words(const BenchResult& result);
/// Where, when and with what: "Xeon ..., 2 threads on 2 cores, 93 % of a core a thread, 2026-11-22; Scree 0.1.0, build
/// 0123456789abcdef".
std::string machine_words(const Machine& machine, double processor_share);
/// Short numbers: "1.23 M", "45.6 k".
std::string count_words(double number);
std::string seconds_words(double seconds);
std::string bytes_words(uint64_t bytes);
/// Per second of processors.
double rate(uint64_t number, const MethodResult& method);

} // namespace scree
