#pragma once

#include "render/grains/exemplar.h"
#include "render/grains/library/grain_library.h"
#include "render/materials/material.h"

#include <filesystem>
#include <optional>

namespace scree {

/// Where a grain's shape comes from: a user's mesh or the library. If neither, it is the bounding sphere itself.
struct ShapeSource {
    std::optional<std::filesystem::path> mesh;
    const LibraryGrain* library = nullptr;
    ShapeOptions options; ///< for the library's mesh

    /// Whether it is a mesh rather than the bounding sphere.
    bool has_mesh() const { return mesh || (library && (library->default_triangles > 0 || options.triangles > 0)); }
};

/// Identifies a shape without making it: a hash of the user's file, or of the options of the library grain; 0 for the
/// sphere. It is a key of caches. Throws InputError for a file that cannot be read.
uint64_t hash_shape(const ShapeSource& source);

/// Makes the exemplar of a shape that has a mesh. place: for errors of shapes that are not files; name: the grain type.
/// Throws InputError, also if the material is a dielectric and the mesh is not closed.
std::shared_ptr<const Exemplar> make_exemplar(const EmbreeDevice& device, const ShapeSource& source,
                                              const Material& material, const std::string& place,
                                              const std::string& name);

} // namespace scree
