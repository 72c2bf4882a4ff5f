#pragma once

#include "render/bench/bench_result.h"

#include <string>

namespace scree {

/// The result as a table for the terminal.
std::string table_of(const BenchResult& result);

/// All that was measured, as JSON.
std::string json_of(const BenchResult& result);

} // namespace scree
