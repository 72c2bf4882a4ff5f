#pragma once

#include "render/build/part_report.h"
#include "render/build/type_builder.h"
#include "render/scene/scene_description.h"
#include "render/trace/world.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// One frame of a scene, ready to be traced, and how it was built.
struct BuiltFrame {
    std::shared_ptr<const World> world;
    TransportPlan plan;
    std::vector<PartReport> parts; ///< built or skipped, in order
    std::vector<std::string> warnings; ///< remarks on the input that are not errors (a truncated last frame, ...)
    uint64_t hash = 0; ///< of the scene's text and of every file and number the world was built from
    std::optional<double> medium_depth; ///< mean radii: depth from which a medium replaces the grains, if any
    size_t frame = 0;
    std::string name; ///< file and step; empty without a dump
};

/// Builds the frames of a scene. What frames share (exemplars, environment maps, surfaces) is read once, when the first
/// frame needs it.
class WorldBuilder {
public:
    /// Finds the frames of the scene's dump. Throws InputError.
    explicit WorldBuilder(SceneDescription scene);
    ~WorldBuilder();

    const SceneDescription& scene() const;
    /// Number of frames of the assembly; 1 when it has no dump.
    size_t frame_count() const;
    std::shared_ptr<const EmbreeDevice> device() const;

    /// Reads frame `frame` and everything it needs. Throws InputError, or Cancelled during precomputation.
    BuiltFrame build(size_t frame, const Progress& progress = {}, Precompute precompute = Precompute::now);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
