#pragma once

#include "render/grains/exemplar.h"
#include "render/grains/library/grain_library.h"
#include "render/materials/material.h"

#include <filesystem>
#include <optional>

namespace scree {

/// Where a grain's shape comes from: a user's mesh, the library, or neither: the bounding sphere itself.
struct ShapeSource {
    std::optional<std::filesystem::path> mesh;
    const LibraryGrain* library = nullptr;
    ShapeOptions options; ///< of the library's mesh

    /// Whether it is a mesh rather than the bounding sphere.
    bool has_mesh() const { return mesh || (library && (library->default_triangles > 0 || options.triangles > 0)); }
};

/// Names a shape, without making it: by the bytes of the user's file, or by what the library makes it from; 0 for the
/// sphere. Caches are keyed by it. Throws InputError for a file that cannot be read.
uint64_t hash_shape(const ShapeSource& source);

/// Makes a shape that has a mesh. `place` is named where the shape is not a file; `name` is the grain's.
/// Throws InputError, also where the material is a dielectric and the mesh does not enclose anything.
std::shared_ptr<const Exemplar> make_exemplar(const EmbreeDevice& device, const ShapeSource& source,
                                              const Material& material, const std::string& place,
                                              const std::string& name);

} // namespace scree
