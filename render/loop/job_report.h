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

/// All that was built for the builder's last world, would be, or is skipped, and why, but for the acceleration
/// structure. is_cropped: only a part of the picture is asked for.
std::vector<PartReport> all_parts(const WorldBuilder& builder, const World& world, bool is_cropped);

/// What would be built for this world and what is skipped, and why; a line a part.
std::string plan_text(const WorldBuilder& builder, const World& world, size_t frame, bool is_cropped);

std::string statistics_text(const FrameReport& report);

/// All frames as one JSON object; integrator: by its name.
std::string statistics_json(const std::vector<FrameReport>& reports, const std::string& integrator);

/// One sample again, vertex by vertex, in the scene's unit.
std::string debug_text(const World& world, const Tracer& tracer, const Camera& camera, const Filter& filter,
                       const SamplePlace& place, const RenderOptions& options);

} // namespace scree
