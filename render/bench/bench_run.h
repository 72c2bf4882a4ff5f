#pragma once

#include "render/bench/bench_result.h"

namespace scree {

/// Renders the reference, then all methods with all seeds, and measures their errors.
///
/// The methods take turns (A B C A B C ...) in slices that grow; within a turn all slices take the same time. The
/// reference is kept in the job's folder as reference.exr. Throws InputError, Cancelled.
BenchResult run_bench(const BenchJob& job, const Progress& progress);

} // namespace scree
