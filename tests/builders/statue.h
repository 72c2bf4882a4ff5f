#pragma once

#include "ingest/meshes/triangle_mesh.h"

namespace scree {

/// A robed figure with arms on a plinth: height 1 along z from 0, facing -y, with folds and ripples down to 1/100 of
/// the height.
///
/// Closed, one surface, the same in every run. cells: of the lattice it is drawn on, along the height; 180 give 330,000
/// triangles.
TriangleMesh statue_mesh(int cells = 180);

} // namespace scree
