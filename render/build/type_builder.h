#pragma once

#include "base/progress.h"
#include "render/build/part_report.h"
#include "render/gsdf/gsdf_builder.h"
#include "render/scene/scene_description.h"
#include "render/scene/transport_plan.h"
#include "render/trace/world.h"

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace scree {

/// Whether slow parts are computed, or only reported (for `--plan`; such a world cannot be rendered).
enum class Precompute : uint8_t { now, never };

/// What every builder of a frame gets: the plan, and where to report.
struct BuildContext {
    const TransportPlan& plan;
    Precompute precompute;
    const Progress& progress;
    std::vector<PartReport>& parts;
    std::vector<std::string>& warnings;
};

/// GSDF options with the error of an accuracy.
GsdfOptions gsdf_options(Accuracy accuracy);

/// Builds the grain types of worlds: exemplars for explicit geometry, GSDFs for proxies and media. Frames share what is
/// built; a type is built only when a frame has a grain of it.
class TypeBuilder {
public:
    explicit TypeBuilder(std::shared_ptr<const EmbreeDevice> device) : device_(std::move(device)) {}

    /// Adds all types to `world` (whose space is set) with the parts that the used types need, and a report on each
    /// part. Returns `hash` combined with the shapes. Throws InputError, or Cancelled.
    uint64_t build(const std::vector<GrainTypeDescription>& types, const std::vector<uint8_t>& used,
                   const BuildContext& context, World& world, uint64_t hash);

private:
    struct Shape {
        std::shared_ptr<const Exemplar> exemplar; ///< null until it is needed, and for the sphere itself
        std::shared_ptr<const Gsdf> gsdf;
        uint64_t hash = 0; ///< of the user's file, or of the library's parameters; 0: the sphere
    };
    std::shared_ptr<const Exemplar> make_exemplar(const GrainTypeDescription& type) const;
    void add_exemplar(const GrainTypeDescription& type, Shape& shape, const BuildContext& context) const;
    void add_gsdf(const GrainTypeDescription& type, Shape& shape, const BuildContext& context);

    std::shared_ptr<const EmbreeDevice> device_;
    std::map<std::string, Shape> shapes_; ///< by grain type
    std::map<uint64_t, std::shared_ptr<const Gsdf>> gsdfs_; ///< by gsdf_key
};

} // namespace scree
