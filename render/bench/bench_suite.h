#pragma once

#include "render/bench/bench_job.h"

#include <filesystem>
#include <vector>

namespace scree {

/// Reads which scenes are benchmarked together, and for how long each.
///
/// A JSON file: {"scenes": [{"name": "pour", "scene": "../pour/scene.json", "frame": 9, "size": [160, 120],
/// "integrators": ["auto", "ept"], "accuracy": ["standard"], "time": 20, "reference_time": 60, "reference_integrator":
/// "ept", "seeds": 4}]}. Only name and scene are required. scale: factor of all times. Throws
/// InputError.
std::vector<BenchJob> read_suite(const std::filesystem::path& file, double scale);

/// The default suite: examples/bench/suite.json in the current folder, else in a folder above the program. Throws
/// InputError.
std::filesystem::path usual_suite();

} // namespace scree
