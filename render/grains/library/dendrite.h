#pragma once

#include "ingest/meshes/triangle_mesh.h"
#include "render/grains/library/shape_random.h"

#include <vector>

namespace scree {

/// A six-fold figure in the plane as a simple polygon, with the middle lines of its limbs.
struct Dendrite {
    std::vector<V2d> outline; ///< counter-clockwise
    /// Inside the outline, each from the beginning of a limb to its tip; lines meet at shared points.
    std::vector<std::vector<V2d>> middle_lines;
};

/// How an arm branches; lengths are in units of the arm's length.
struct DendriteOptions {
    double plate = 0.22; ///< radius of the hexagon in the middle
    double width = 0.045; ///< half width of an arm
    double branch_length = 0.42;
    int branches = 6; ///< on each side of an arm
    int twigs = 4; ///< on each side of a branch
};

/// Makes a figure of six equal arms, because real arms grow in the same weather. random: gives the positions and
/// lengths of the branches.
Dendrite make_dendrite(const DendriteOptions& options, ShapeRandom& random);

/// Triangulates the figure (counter-clockwise, z = 0). The vertices of the outline come first, then the other vertices
/// of the middle lines.
TriangleMesh triangulate(const Dendrite& figure);

} // namespace scree
