#pragma once

#include "render/loop/render_job.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// One of the ways to render a scene that a bench compares.
struct BenchMethod {
    std::string name; ///< e.g. "ppt" or "auto draft"
    std::vector<SceneOverride> switches; ///< of the scene's; none: as the scene has it
};

/// An integrator, and with auto perhaps an accuracy.
BenchMethod bench_method(IntegratorKind kind, std::optional<Accuracy> accuracy = {});

/// What `scree bench` was asked to do with one scene.
struct BenchJob {
    std::string title; ///< of the page
    RenderJob scene; ///< file, size, replaced values, seed, threads: all that methods do not set
    size_t frame = 0;
    std::vector<BenchMethod> methods;
    double seconds = 20; ///< rendering time of each method, if every thread has a processor of its own
    size_t seeds = 4; ///< independent pictures of each method, at least 2
    std::filesystem::path reference; ///< a picture to compare with; empty: one is rendered
    double reference_seconds = 60; ///< as `seconds`, of the reference
    BenchMethod reference_method = bench_method(IntegratorKind::ept);
    std::filesystem::path folder; ///< for what is written
    bool quiet = false;
};

/// Makes methods from comma-separated names of integrators and accuracies: auto is combined with each accuracy, the
/// others have none. Throws an InputError that names the option.
std::vector<BenchMethod> parse_methods(const std::string& integrators, const std::string& accuracies);

/// The job of `scree render` that renders the scene with this method.
RenderJob render_job_of(const BenchJob& job, const BenchMethod& method);

} // namespace scree
