#pragma once

#include "render/scene/part_report.h"
#include "render/scene/scene_description.h"
#include "render/scene/world.h"

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace scree {

/// Makes the grain types of worlds; what frames share is made once, and only when a frame has a grain of the type.
class TypeBuilder {
public:
    explicit TypeBuilder(std::shared_ptr<const EmbreeDevice> device) : device_(std::move(device)) {}

    /// Adds every type to `world` (whose space is set), the exemplars of those used, and a report on each.
    /// Returns `hash` with the shapes mixed in. Throws InputError.
    uint64_t build(const std::vector<GrainTypeDescription>& types, const std::vector<uint8_t>& used, World& world,
                   std::vector<PartReport>& parts, uint64_t hash);

private:
    struct Shape {
        std::shared_ptr<const Exemplar> exemplar;
        uint64_t hash = 0; ///< of the user's mesh, or of what the library makes it from
    };
    Shape make_shape(const GrainTypeDescription& type) const;

    std::shared_ptr<const EmbreeDevice> device_;
    std::map<std::string, Shape> shapes_; ///< by grain type
};

} // namespace scree
