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

/// Every part of a frame, built (or to be built) or skipped, and why; without the acceleration structure. is_cropped:
/// only a part of the picture is rendered.
std::vector<PartReport> all_parts(const SceneDescription& scene, const BuiltFrame& built, bool is_cropped);

/// all_parts() as text, one line for each part. frame_count: of the scene.
std::string plan_text(const SceneDescription& scene, const BuiltFrame& built, size_t frame_count, bool is_cropped);

std::string statistics_text(const FrameReport& report);

/// All frames as one JSON object. integrator: its name.
std::string statistics_json(const std::vector<FrameReport>& reports, const std::string& integrator);

/// Traces one sample again and lists its vertices, in the scene's unit.
std::string debug_text(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter,
                       const SamplePlace& place, const RenderOptions& options);

} // namespace scree
