#pragma once

#include "packing/solids/exact_distance.h"

#include "ingest/meshes/triangle_mesh.h"

#include <memory>
#include <optional>
#include <vector>

namespace scree {

/// Finds the triangles near a place or above it (CGAL's tree of boxes); its answers are exact.
///
/// Any thread may ask. Positions must be finite; queries too.
class SurfaceTree {
public:
    /// Needs at least one triangle, and none without area. The mesh must outlive the tree.
    explicit SurfaceTree(const TriangleMesh& mesh);
    ~SurfaceTree();
    SurfaceTree(const SurfaceTree&) = delete;
    SurfaceTree& operator=(const SurfaceTree&) = delete;

    /// Whether a triangle is nearer to the centre than the radius, or touches the centre itself.
    bool reaches_into_ball(const Imath::V3d& centre, double radius) const;

    /// Whether an odd number of triangles is above the point (towards +z), so that a closed surface encloses it. For
    /// points on the surface the answer may be either.
    bool encloses(const Imath::V3d& point) const;

    /// Whether the places just in front of a face (on its normal's side) are not enclosed; nothing when the face is
    /// vertical. No other face may touch the middle of this face.
    std::optional<bool> looks_outward(uint32_t face) const;

    /// Distance to the nearest triangle, within some 1e-14 of the bounds.
    double distance(const Imath::V3d& point) const;

    /// Bounds on that distance with lo at least about (1 - slack) hi; much cheaper far from the surface.
    DistanceBounds rough_distance(const Imath::V3d& point, double slack) const;

    /// Appends all triangles that are within a distance of the point, and perhaps some that are not.
    void collect_near(const Imath::V3d& point, double distance, std::vector<Corners>& triangles) const;
    /// The same, with the triangles' numbers in the mesh.
    void collect_near(const Imath::V3d& point, double distance, std::vector<uint32_t>& faces) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
