#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <Imath/ImathBox.h>

#include <memory>

namespace scree {

/// Answers about a solid from all its triangles, in arithmetic that is never wrong: CGAL's intervals where they decide,
/// else its rational squared distances, and its exact orientations. Shares no code with Domain. Any thread.
class ExactSolid {
public:
    explicit ExactSolid(const TriangleMesh& mesh);
    ~ExactSolid();
    ExactSolid(const ExactSolid&) = delete;
    ExactSolid& operator=(const ExactSolid&) = delete;

    /// Whether the whole ball is inside.
    bool contains_sphere(const Imath::V3d& centre, double radius) const;
    /// By counting crossings of a slanted ray; takes another ray if one meets an edge. Not for points on the surface.
    bool encloses(const Imath::V3d& point) const;
    /// Unsigned distance: the root of the exact least square, rounded to double.
    double distance(const Imath::V3d& point) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The sign of (exact squared distance from a point to a triangle) minus (exact square of `distance`).
int compare_distance(const Imath::V3d& point, const Imath::V3d& a, const Imath::V3d& b, const Imath::V3d& c,
                     double distance);

} // namespace scree
