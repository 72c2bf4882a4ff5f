#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <Imath/ImathBox.h>

#include <memory>
#include <string>
#include <vector>

namespace scree {

class SurfaceTree;

/// A first thing that is wrong with a mesh as the boundary of a solid, told with its place.
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

/// What keeps the mesh from being the boundary of a solid: empty when nothing does. Checks go from cheap to dear, and
/// only the first kind of defect met is reported (how many there are, and where the first is).
std::vector<MeshDefect> find_defects(const TriangleMesh& mesh);

/// Tries to make a mesh the boundary of a solid (CGAL's soup repair, stitching, small holes filled, orientation); says
/// in `changes` what was done. The result may still have defects.
TriangleMesh repair_mesh(const TriangleMesh& mesh, std::vector<std::string>& changes);

/// The solid inside a closed, oriented, non-self-intersecting mesh (several shells and cavities are one solid). Answers
/// are exact for the vertices as given; all of them may be asked from several threads.
class Domain {
public:
    /// Throws InputError naming `place` and the first defect.
    Domain(TriangleMesh mesh, std::string place);
    ~Domain();
    Domain(const Domain&) = delete;
    Domain& operator=(const Domain&) = delete;

    const TriangleMesh& mesh() const;
    const std::string& place() const;
    const Imath::Box3d& bounds() const;
    /// By the divergence theorem.
    double volume() const;

    /// Whether the point is in the interior; points of the surface are not.
    bool contains(const Imath::V3d& point) const;
    /// Whether the whole ball is inside: its centre is, and no triangle is nearer than the radius (equal will do).
    /// Exact: arithmetic in double with an error bound decides, and exact arithmetic where that does not.
    bool contains_sphere(const Imath::V3d& centre, double radius) const;
    /// Distance to the surface (unsigned, correctly rounded to some 1e-14 of the bounds).
    double distance(const Imath::V3d& point) const;
    /// The triangles, for questions that are not asked of the whole solid.
    const SurfaceTree& surface() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
