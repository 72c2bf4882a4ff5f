#pragma once

#include "render/bench/bench_job.h"

#include <filesystem>
#include <vector>

namespace scree {

/// Which scenes are benchmarked together, and for how long each.
///
/// A JSON file: {"scenes": [{"name": "pour", "scene": "../pour/scene.json", "frame": 9, "size": [160, 120],
/// "integrators": ["auto", "ept"], "accuracy": ["standard"], "time": 20, "reference_time": 60, "reference_integrator":
/// "ept", "seeds": 4}]}. Only name and scene are needed. scale: of all times. Throws InputError.
std::vector<BenchJob> read_suite(const std::filesystem::path& file, double scale);

/// examples/bench/suite.json of the folder where we are, or of one above the program. Throws InputError.
std::filesystem::path usual_suite();

} // namespace scree
