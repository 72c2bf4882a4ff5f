#pragma once

#include "packing/fill/procedural_fill.h"
#include "render/build/part_report.h"
#include "render/scene/scene_description.h"

#include <memory>
#include <vector>

namespace scree {

/// A scene's fill with the mixture of its spheres, and the cost of building them.
struct BuiltFill {
    std::shared_ptr<const ProceduralFill> fill;
    std::shared_ptr<const Mixture> mixture;
    std::vector<PartReport> parts;
    std::vector<std::string> remarks; ///< repairs of the mesh
};

/// Reads the mesh and the tile of the scene's assembly, which must be a fill. Throws InputError.
BuiltFill build_fill(const SceneDescription& scene);

} // namespace scree
