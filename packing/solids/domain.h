#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <Imath/ImathBox.h>

#include <memory>
#include <string>
#include <vector>

namespace scree {

class SurfaceTree;

/// A defect that keeps a mesh from being the boundary of a solid, with its place.
struct MeshDefect {
    enum class Kind {
        empty,
        not_finite,
        degenerate,
        open,
        not_manifold,
        not_oriented,
        self_intersecting,
        inside_out
    } kind;
    std::string found; ///< e.g. "edge 12-13 from (0, 0, 1) to (0, 1, 1) has one face"
    std::string hint;
};

/// Finds what keeps the mesh from being the boundary of a solid; empty when nothing does. Checks go from cheap to
/// expensive, and only the first kind of defect is reported (how many there are, and where the first one is).
std::vector<MeshDefect> find_defects(const TriangleMesh& mesh);

/// Tries to make a mesh the boundary of a solid (CGAL: repairs the soup, stitches borders, fills small holes, orients
/// faces), and lists in `changes` what was done. The result may still have defects.
TriangleMesh repair_mesh(const TriangleMesh& mesh, std::vector<std::string>& changes);

/// The solid inside a closed, oriented, non-self-intersecting mesh (several shells and cavities form one solid).
/// Answers are exact for the given vertices. Any thread may ask.
class Domain {
public:
    /// Throws InputError with `place` and the first defect.
    Domain(TriangleMesh mesh, std::string place);
    ~Domain();
    Domain(const Domain&) = delete;
    Domain& operator=(const Domain&) = delete;

    const TriangleMesh& mesh() const;
    const std::string& place() const;
    const Imath::Box3d& bounds() const;
    /// By the divergence theorem.
    double volume() const;

    /// Whether the point is in the interior; points on the surface are not.
    bool contains(const Imath::V3d& point) const;
    /// Whether the whole ball is inside: its centre is inside, and no triangle is nearer than the radius (equal is
    /// allowed). Exact: double arithmetic with an error bound decides where it can, exact arithmetic elsewhere.
    bool contains_sphere(const Imath::V3d& centre, double radius) const;
    /// Distance to the surface (unsigned, correctly rounded to some 1e-14 of the bounds).
    double distance(const Imath::V3d& point) const;
    /// The triangles, for questions about the surface alone.
    const SurfaceTree& surface() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
