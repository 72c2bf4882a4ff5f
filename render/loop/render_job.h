#pragma once

#include "render/loop/render_loop.h"
#include "render/scene/load_scene.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree {

struct FrameRange {
    size_t first = 0, last = 0, step = 1; ///< last included
};

/// Everything `scree render` was asked to do.
struct RenderJob {
    std::filesystem::path scene;
    std::vector<std::string> outputs; ///< empty: the scene's name with .exr
    std::optional<uint32_t> spp; ///< samples per pixel
    std::vector<SceneOverride> overrides; ///< values of the scene that -D replaces
    std::vector<SceneOverride> switches; ///< values of the scene that flags replace
    std::optional<FrameRange> frames;
    std::optional<std::array<double, 4>> crop; ///< x0, x1, y0, y1 in 0..1
    std::optional<std::array<int, 4>> pixel_bounds;
    int threads = 0; ///< 0: all cores
    RenderOptions options;
    bool resume = false, plan_only = false, stats = false, quiet = false;
    std::filesystem::path stats_json;
    std::optional<SamplePlace> debug_sample;

    /// Replaces a value of the scene as a flag of the command line does: set("--integrator", "ept"). Throws InputError.
    void set(const std::string& flag, const std::string& text);
};

/// Renders. Returns the program's exit status: 0, or 130 when interrupted (the pictures then hold the samples so far).
/// Throws InputError.
int run_render_job(const RenderJob& job);

} // namespace scree
