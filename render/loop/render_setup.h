#pragma once

#include "render/build/world_builder.h"
#include "render/film/filter.h"
#include "render/loop/render_job.h"

#include <memory>
#include <vector>

namespace scree {

/// The job's scene, with the values that the command line replaces. Throws InputError.
SceneDescription load_scene(const RenderJob& job);

/// The scene's camera for the scene's film size, in render coordinates.
Camera make_camera(const SceneDescription& scene, const RenderSpace& space);

/// One frame ready to be rendered: world, tracer, camera, filter and options.
class RenderSetup {
public:
    /// Builds the acceleration structures of a frame of the builder's scene.
    RenderSetup(const WorldBuilder& builder, const BuiltFrame& built, const RenderJob& job);

    const World& world() const { return *world_; }
    const Tracer& tracer() const { return tracer_; }
    const Camera& camera() const { return camera_; }
    const Filter& filter() const { return filter_; }
    const RenderOptions& options() const { return options_; }
    const std::vector<PartReport>& parts() const { return parts_; } ///< built or skipped

private:
    RenderSetup(const WorldBuilder& builder, const BuiltFrame& built, const RenderJob& job, int64_t bytes_before,
                const Stopwatch& watch);

    std::shared_ptr<const World> world_;
    Tracer tracer_;
    Camera camera_;
    Filter filter_;
    RenderOptions options_;
    std::vector<PartReport> parts_;
};

} // namespace scree
