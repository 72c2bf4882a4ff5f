#pragma once

#include "render/bench/bench_result.h"

namespace scree {

/// Renders the reference, then all methods in turns (A B C A B C ...), in slices that grow and take each the same time,
/// over all seeds, and measures. The reference is kept in the job's folder as reference.exr. Throws InputError,
/// Cancelled.
BenchResult run_bench(const BenchJob& job, const Progress& progress);

} // namespace scree
