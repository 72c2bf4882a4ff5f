#pragma once

#include "render/loop/render_loop.h"
#include "render/scene/scene_description.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace scree {

struct FrameRange {
    size_t first = 0, last = 0, step = 1; ///< last included
};

/// Everything `scree render` was asked to do.
struct RenderJob {
    std::filesystem::path scene;
    std::vector<std::string> outputs; ///< empty: the scene's name with .exr
    std::optional<uint32_t> spp;
    std::optional<IntegratorKind> integrator; ///< else the scene's, as the next nine
    std::optional<Accuracy> accuracy;
    std::optional<uint32_t> explicit_grains;
    std::optional<double> grain_depth;
    std::optional<double> grain_pixels, grain_flights, least_shell;
    std::optional<EquivalentForm> medium_form;
    std::optional<bool> shells;
    std::optional<StfForm> stf_form;
    std::optional<FrameRange> frames;
    std::optional<std::pair<int, int>> size;
    std::optional<std::array<double, 4>> crop; ///< x0, x1, y0, y1 in 0..1
    std::optional<std::array<int, 4>> pixel_bounds;
    std::vector<Aov> aov; ///< besides the scene's
    int threads = 0; ///< 0: all cores
    uint32_t max_depth = 0;
    RenderOptions options;
    bool resume = false, plan_only = false, stats = false, quiet = false;
    std::filesystem::path stats_json;
    std::optional<SamplePlace> debug_sample;
    std::vector<std::pair<std::string, std::string>> overrides; ///< path in the scene, JSON
};

/// Renders; returns the program's exit status: 0, or 130 when interrupted (the pictures hold what there was).
/// Throws InputError.
int run_render_job(const RenderJob& job);

} // namespace scree
