#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <Imath/ImathBox.h>

#include <memory>

namespace scree {

/// Answers about a solid by going through all its triangles, in arithmetic that cannot be wrong: CGAL's intervals where
/// they decide, its rational squared distances where they do not, its exact orientations. Shares nothing with Domain.
/// Any thread.
class ExactSolid {
public:
    explicit ExactSolid(const TriangleMesh& mesh);
    ~ExactSolid();
    ExactSolid(const ExactSolid&) = delete;
    ExactSolid& operator=(const ExactSolid&) = delete;

    /// Whether the ball is inside.
    bool contains_sphere(const Imath::V3d& centre, double radius) const;
    /// By the crossings of a slanted ray; another one where it meets an edge. Not for points of the surface.
    bool encloses(const Imath::V3d& point) const;
    /// Unsigned, the root of the exact least square rounded to double.
    double distance(const Imath::V3d& point) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Square of the distance from a point to a triangle as a rational number, less that of `distance`: its sign.
int compare_distance(const Imath::V3d& point, const Imath::V3d& a, const Imath::V3d& b, const Imath::V3d& c,
                     double distance);

} // namespace scree
