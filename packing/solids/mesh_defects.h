#pragma once

#include "packing/solids/domain.h"

#include <optional>

namespace scree {

/// The first defect but for inside_out, which needs a SurfaceTree and that there is no other.
std::optional<MeshDefect> find_surface_defect(const TriangleMesh& mesh);

/// The defect of shells that look into the solid, given a face of each; nothing when there are none.
std::optional<MeshDefect> describe_inside_out(const TriangleMesh& mesh, const std::vector<uint32_t>& faces);

} // namespace scree
