#pragma once

#include "ingest/meshes/triangle_mesh.h"

#include <chrono>
#include <filesystem>
#include <string>

namespace scree {

/// Tetrahedra between the faces of a surface.
struct Tetrahedra {
    std::vector<Imath::V3d> points;
    std::vector<std::array<uint32_t, 4>> cells;
    std::vector<int32_t> region; ///< of each cell; regions are separated by faces
};

/// How TetGen is run, and how much it may use.
struct TetgenOptions {
    std::filesystem::path program; ///< empty: scree-tetgen in the folder of the running program
    std::chrono::milliseconds time{30'000};
    uint64_t megabytes = 4096;
};

/// Fills what a surface encloses, cavities too, with tetrahedra by TetGen in a process of its own (`scree-tetgen`).
/// Faces stay whole, so volumes are exact; points beside the surface's own are inner ones.
///
/// Any input will do: nothing happens to this program. Empty when TetGen fails; `trouble` then tells why. Coordinates
/// are moved and scaled on the way so that the result has those of the surface.
Tetrahedra tetrahedralize(const TriangleMesh& mesh, const TetgenOptions& options, std::string& trouble);

} // namespace scree
