#pragma once

#include "ingest/particles/dump_series.h"
#include "render/build/part_report.h"
#include "render/build/type_builder.h"
#include "render/scene/scene_description.h"
#include "render/trace/world.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// Makes worlds out of a scene, frame by frame; what frames share (exemplars, environment maps, surfaces) is read once,
/// and only when a frame needs it.
class WorldBuilder {
public:
    /// Finds the frames of the scene's dump. Throws InputError.
    explicit WorldBuilder(SceneDescription scene);
    ~WorldBuilder();

    const SceneDescription& scene() const;
    /// Frames of the assembly; 1 when it has no dump.
    size_t frame_count() const;
    /// File and step of a frame; empty without a dump.
    std::string frame_name(size_t frame) const;
    /// Remarks on the input that are no errors (a truncated last frame, ...).
    std::vector<std::string> warnings() const;

    /// Reads frame `frame` and everything it needs. Throws InputError, or Cancelled from within what is precomputed.
    std::shared_ptr<const World> build(size_t frame, const Progress& progress = {},
                                       Precompute precompute = Precompute::now);
    /// Of the last world built.
    const TransportPlan& plan() const;
    /// Mean radii below every face from where on a medium stands for grains of the last world built; nothing: none
    /// does.
    std::optional<double> medium_depth() const;
    /// The parts of the last world built, in order.
    const std::vector<PartReport>& parts() const;
    /// Hash of the scene's text and of what the last world was built from.
    uint64_t scene_hash() const;
    std::shared_ptr<const EmbreeDevice> device() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
