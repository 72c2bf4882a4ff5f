#pragma once

#include "packing/solids/domain.h"

#include <optional>

namespace scree {

/// The first defect, except inside_out: that check needs a SurfaceTree, and a mesh without any other defect.
std::optional<MeshDefect> find_surface_defect(const TriangleMesh& mesh);

/// The defect of shells that face into the solid, given one face of each shell; nothing when there are none.
std::optional<MeshDefect> describe_inside_out(const TriangleMesh& mesh, const std::vector<uint32_t>& faces);

} // namespace scree
