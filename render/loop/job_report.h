#pragma once

#include "render/build/world_builder.h"
#include "render/loop/render_loop.h"

#include <string>
#include <vector>

namespace scree {

/// What rendering one frame took.
struct FrameReport {
    size_t frame = 0;
    std::string name;
    std::vector<PartReport> parts;
    double setup_seconds = 0;
    uint64_t grains = 0;
    RenderStatistics statistics{};
};

/// Everything that was built for a frame, or would be, or is skipped, and why; without the acceleration structure.
/// is_cropped: only a part of the picture is asked for.
std::vector<PartReport> all_parts(const SceneDescription& scene, const BuiltFrame& built, bool is_cropped);

/// The same as text, a line a part. frame_count: of the scene.
std::string plan_text(const SceneDescription& scene, const BuiltFrame& built, size_t frame_count, bool is_cropped);

std::string statistics_text(const FrameReport& report);

/// All frames as one JSON object; integrator: by its name.
std::string statistics_json(const std::vector<FrameReport>& reports, const std::string& integrator);

/// One sample again, vertex by vertex, in the scene's unit.
std::string debug_text(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter,
                       const SamplePlace& place, const RenderOptions& options);

} // namespace scree
