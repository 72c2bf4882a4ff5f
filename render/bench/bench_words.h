#pragma once

#include "render/bench/bench_result.h"

#include <string>

namespace scree {

// Results as text, the same in the terminal and on the page.

/// The bias as "0.83 % (0.71 to 0.94)", or "< 0.4 %" where it is too small to tell from chance.
std::string bias_words(const Measured& squared_bias);
/// "+0.31 -0.02 +0.10 +- 0.12" per cent of red, green and blue, with the largest of their standard errors.
std::string colors_words(const std::array<Measured, 3>& colors);
/// The relative error in per cent, or "< 1.3 % (ref.)" where it is below the reference's noise of 1.3 %.
std::string error_words(const ErrorEstimate& estimate);
/// The square root of a relative number as "1.3 %".
std::string root_words(double squared);
/// BenchResult::gain as "2.5 +- 0.1 x".
std::string gain_words(const BenchResult& result, const MethodResult& method);
/// Processor seconds, with "(cache)" if part of the set-up was read from a cache.
std::string setup_words(const SetupTime& setup);
/// A mean FLIP, marked "(ref.)" where it is no larger than the mean FLIP between the reference's halves.
std::string flip_words(const BenchResult& result, double flip);
/// The noise of the reference, relative.
std::string noise_words(const BenchResult& result);
/// What was rendered and for how long, and the reference.
std::string scene_words(const BenchResult& result);
/// Where, when and with what: "Xeon ..., 2 threads on 2 cores, 93 % of a core per thread, 2026-11-22; Scree 0.1.0,
/// build 0123456789abcdef".
std::string machine_words(const Machine& machine, double processor_share);
/// Short numbers: "1.23 M", "45.6 k".
std::string count_words(double number);
std::string seconds_words(double seconds);
std::string bytes_words(uint64_t bytes);
/// `number` over the processor seconds of the method's rendering.
double rate(uint64_t number, const MethodResult& method);

} // namespace scree
