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
    std::vector<int32_t> region; ///< of each cell; faces separate the regions
};

/// How TetGen is run, and how much it may use.
struct TetgenOptions {
    std::filesystem::path program; ///< empty: scree-tetgen in the folder of the running program
    std::chrono::milliseconds time{30'000};
    uint64_t megabytes = 4096;
};

/// Fills all that a surface encloses, cavities too, with tetrahedra: runs TetGen in a separate process
/// (`scree-tetgen`). Faces are kept whole, so volumes are exact; the points that TetGen adds are inside.
///
/// Any input is safe: it cannot harm this program. The result is empty when TetGen fails; `trouble` then says why. The
/// coordinates are moved and scaled for TetGen; the result has the surface's own coordinates again.
Tetrahedra tetrahedralize(const TriangleMesh& mesh, const TetgenOptions& options, std::string& trouble);

} // namespace scree
