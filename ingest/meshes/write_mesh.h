#pragma once

#include "ingest/meshes/triangle_mesh.h"

namespace scree {

/// Writes OBJ, PLY (binary), STL (binary) or OFF, by extension; the file appears whole or not at all. Coordinates keep
/// all their digits (double) but in STL, which has floats. Throws InputError, for an unknown extension before anything
/// else.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

/// Throws InputError when `write_mesh` knows no format of this extension.
void check_mesh_extension(const std::filesystem::path& path);

} // namespace scree
