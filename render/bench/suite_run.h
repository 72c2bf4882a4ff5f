#pragma once

#include "render/bench/bench_job.h"

#include <filesystem>
#include <vector>

namespace scree {

struct BenchResult;

/// Runs the benches one after the other and writes what they found.
///
/// To `folder`: index.html, README.md, suite.json and a <name>.svg each, all small; to folder/details/<name> a page, numbers and the
/// reference of each. readme: if not empty, the numbers go into its block too (with_block). Prints one screen. Throws InputError, Cancelled.
void run_suite(const std::vector<BenchJob>& jobs, const std::filesystem::path& folder, const std::filesystem::path& readme, const Progress& progress);

/// Runs one bench and writes its page and numbers to its folder. Throws InputError, Cancelled.
BenchResult run_and_write(const BenchJob& job, const Progress& progress);

} // namespace scree
