#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <cstdint>

namespace scree {

/// A unit sphere as an icosahedron whose faces are split in four `level` times: 20 * 4^level triangles.
TriangleMesh icosphere(int level);

/// An axis-aligned box of edges 2 around the origin, 12 triangles.
TriangleMesh cube();

/// A flat rectangle from (-half, -half, z) to (half, half, z), facing up.
TriangleMesh ground(double half, double z);

} // namespace scree
