#pragma once

#include "render/bench/bench_job.h"
#include "render/bench/suite_report.h"

#include <filesystem>
#include <vector>

namespace scree {

/// Runs the benches one after the other and writes what they found.
///
/// To folder/details/<name>, as each ends, a page, numbers and the reference; when all are done, to `folder`
/// index.html, README.md, suite.json and a <name>.svg each, all small. readme: if not empty, the numbers go into its
/// block too (with_block). suite: its command and scale. Throws InputError, Cancelled: `folder` is then as it was but
/// for the details.
void run_suite(const std::vector<BenchJob>& jobs, SuiteResult& suite, const std::filesystem::path& folder,
               const std::filesystem::path& readme, const Progress& progress);

/// Runs one bench and writes its page and numbers to its folder. Throws InputError, Cancelled.
BenchResult run_and_write(const BenchJob& job, const Progress& progress);

} // namespace scree
