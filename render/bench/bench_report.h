#pragma once

#include "render/bench/bench_result.h"

#include <string>

namespace scree {

/// All measurements as JSON.
std::string json_of(const BenchResult& result);

} // namespace scree
