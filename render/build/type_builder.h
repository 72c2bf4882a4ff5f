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

/// Whether what takes long is made, or only said to be needed (for `--plan`; such a world cannot be rendered).
enum class Precompute : uint8_t { now, never };

/// What every builder of a frame is given: what is planned, and where to report.
struct BuildContext {
    const TransportPlan& plan;
    Precompute precompute;
    const Progress& progress;
    std::vector<PartReport>& parts;
    std::vector<std::string>& warnings;
};

/// With the error that an accuracy asks for.
GsdfOptions gsdf_options(Accuracy accuracy);

/// Makes the grain types of worlds: exemplars where grains are traced as they are, GSDFs where there are proxies.
/// What frames share is made once, and only when a frame has a grain of the type.
class TypeBuilder {
public:
    explicit TypeBuilder(std::shared_ptr<const EmbreeDevice> device) : device_(std::move(device)) {}

    /// Adds every type to `world` (whose space is set), what is needed of those used, and a report on each part.
    /// Returns `hash` with the shapes mixed in. Throws InputError, or Cancelled.
    uint64_t build(const std::vector<GrainTypeDescription>& types, const std::vector<uint8_t>& used,
                   const BuildContext& context, World& world, uint64_t hash);

private:
    struct Shape {
        std::shared_ptr<const Exemplar> exemplar; ///< null until it is needed, and for the sphere itself
        std::shared_ptr<const Gsdf> gsdf;
        uint64_t hash = 0; ///< of the user's file, or of what the library makes it from; 0: the sphere
    };
    std::shared_ptr<const Exemplar> make_exemplar(const GrainTypeDescription& type) const;
    void add_exemplar(const GrainTypeDescription& type, Shape& shape, const BuildContext& context) const;
    void add_gsdf(const GrainTypeDescription& type, Shape& shape, const BuildContext& context);

    std::shared_ptr<const EmbreeDevice> device_;
    std::map<std::string, Shape> shapes_; ///< by grain type
    std::map<uint64_t, std::shared_ptr<const Gsdf>> gsdfs_; ///< by gsdf_key
};

} // namespace scree
