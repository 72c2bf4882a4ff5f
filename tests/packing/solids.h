#pragma once

#include "tests/builders/shapes.h"

namespace scree {

/// A torus around the z axis with 2 * around * along triangles.
TriangleMesh torus(double major, double minor, int around, int along);

/// Two unit spheres (icospheres of a level), the inner one scaled by 1 - thickness and looking inward.
TriangleMesh double_walled_shell(int level, double thickness);

/// The cube -1..1 with a round bore of radius 0.45 along each axis, and with a ball cut from each corner: a mesh of
/// level sets combined by CSG, with `cells` voxels per edge.
TriangleMesh bored_cube(int cells);

/// Both surfaces in one mesh; vertices are not merged.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);

TriangleMesh flipped(TriangleMesh mesh);
TriangleMesh scaled(TriangleMesh mesh, double factor);
TriangleMesh moved(TriangleMesh mesh, const Imath::V3d& by);

} // namespace scree
