#pragma once

#include "ingest/meshes/triangle_mesh.h"

namespace scree {

/// Writes OBJ, PLY (binary), STL (binary) or OFF, by extension; the file is written completely or not at all.
/// Coordinates keep all their digits (double), except in STL, which stores floats. Throws InputError; an unknown
/// extension is checked first.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

/// Throws InputError when `write_mesh` knows no format for this extension.
void check_mesh_extension(const std::filesystem::path& path);

} // namespace scree
