#pragma once

#include "ingest/meshes/triangle_mesh.h"
#include "render/grains/library/shape_random.h"

#include <vector>

namespace scree {

/// A six-fold figure in the plane as a simple polygon, with the middle lines of its limbs.
struct Dendrite {
    std::vector<V2d> outline; ///< counter-clockwise
    std::vector<std::vector<V2d>>
        middle_lines; ///< inside of the outline, from where a limb begins to its tip; meet at shared points
};

/// How an arm is branched; lengths in units of the arm's.
struct DendriteOptions {
    double plate = 0.22; ///< radius of the hexagon in the middle
    double width = 0.045; ///< half width of an arm
    double branch_length = 0.42;
    int branches = 6; ///< on each side of an arm
    int twigs = 4; ///< on each side of a branch
};

/// All six arms alike, as they grow in the same weather; random: where branches stand and how long they are.
Dendrite make_dendrite(const DendriteOptions& options, ShapeRandom& random);

/// Triangles of the figure (counter-clockwise, z = 0): its vertices are those of the outline first, then the others of
/// the middle lines.
TriangleMesh triangulate(const Dendrite& figure);

} // namespace scree
