#pragma once

#include "render/bench/bench_job.h"
#include "render/bench/suite_report.h"

#include <filesystem>
#include <vector>

namespace scree {

/// Runs the benches one after the other and writes their results.
///
/// When a bench ends, folder/details/<name> has its page, numbers and reference. When all are done, `folder` gets
/// index.html, README.md, suite.json and one <name>.svg for each bench, all small. readme: if not empty, its block
/// (with_block) also gets the table. suite: gives command and scale, and receives the results. Throws InputError,
/// Cancelled: then nothing in `folder` has changed except the details.
void run_suite(const std::vector<BenchJob>& jobs, SuiteResult& suite, const std::filesystem::path& folder,
               const std::filesystem::path& readme, const Progress& progress);

/// Runs one bench and writes its page and numbers to its folder. Throws InputError, Cancelled.
BenchResult run_and_write(const BenchJob& job, const Progress& progress);

} // namespace scree
