#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace scree {

/// Triangles over shared vertices, in the file's unit; counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Imath::V3d> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
};

/// A box as 12 triangles, faces looking outward.
TriangleMesh box_mesh(const Imath::V3d& lo, const Imath::V3d& hi);

/// Reads OBJ, PLY, STL or OFF (by extension; text or binary). Polygons are triangulated, and faces without area are
/// dropped. Vertices at exactly the same place are merged: in STL always, in other formats if that closes the surface
/// (as at texture seams). Throws InputError naming the file (in text files also the line) and the defect.
TriangleMesh read_mesh(const std::filesystem::path& path);

/// What `scree info` reports about a mesh.
struct MeshReport {
    uint64_t vertices = 0, faces = 0;
    bool closed = false; ///< every edge has exactly two faces
    bool oriented = false; ///< neighbouring faces agree on which side is out
    uint64_t self_intersections = 0; ///< pairs of faces that meet elsewhere than at a shared edge or vertex
    double volume = 0; ///< signed, by the divergence theorem; negative: faces look inward
    Imath::V3d lo{0}, hi{0}; ///< bounds
};

/// Whether the surface is closed and consistently oriented (edge by edge; cheap).
bool is_closed_and_oriented(const TriangleMesh& mesh);

/// Reads a mesh as `read_mesh` does, but requires it to be closed and consistently oriented, and turns its faces
/// outward. because: why the mesh must be closed, for the InputError.
TriangleMesh read_closed_mesh(const std::filesystem::path& path, const std::string& because);

/// Signed volume by the divergence theorem, summed relative to the middle of the bounds.
double signed_volume(const TriangleMesh& mesh);

/// Computes all of MeshReport; the self-intersections are found exactly, with CGAL.
MeshReport report_mesh(const TriangleMesh& mesh);

} // namespace scree
