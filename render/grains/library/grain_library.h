#pragma once

#include "ingest/meshes/triangle_mesh.h"
#include "render/materials/material.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace scree {

/// One exemplar of the library.
struct LibraryGrain {
    std::string name; ///< the key, e.g. "brown_sugar"
    std::string description; ///< one line
    Material material; ///< absorption per metre, of the real material
    double typical_radius; ///< of the bounding sphere, metres
    uint64_t default_triangles; ///< 0: the shape is the bounding sphere itself
    uint32_t version; ///< counts the changes of its generator and defaults; part of the keys of caches
};

/// The fourteen grain types of Mueller et al. 2016, made by our own generators; render/grains/library/README.md lists
/// shapes, materials and their sources.
const std::vector<LibraryGrain>& grain_library();

/// The library grain of that name, or nullptr.
const LibraryGrain* find_library_grain(std::string_view name);

/// The library grain of that name; throws InputError that suggests the nearest name. place: what asked for the grain.
const LibraryGrain& require_library_grain(const std::string& name, const std::string& place);

/// Which individual of a type to make, and how finely.
struct ShapeOptions {
    uint64_t seed = 0;
    uint64_t triangles = 0; ///< 0: the type's default
    std::map<std::string, double> parameters;
};

inline constexpr uint64_t least_shape_triangles = 20, most_shape_triangles = 4'000'000;

/// The mesh of a library grain, scaled into the unit bounding sphere and oriented outwards. It has `triangles` faces
/// within 20 % (if 0 and the type is the sphere itself, 20,000).
///
/// Meshes of dielectrics are closed and do not intersect themselves. Throws InputError naming `place` for an unknown
/// parameter or a value out of range.
TriangleMesh make_grain_shape(const LibraryGrain& grain, const ShapeOptions& options, const std::string& place);

/// A parameter of a type's generator.
struct ShapeParameter {
    std::string name;
    double value, least, most; ///< value: the default
    std::string what;
};
const std::vector<ShapeParameter>& shape_parameters(const LibraryGrain& grain);

/// Hash of a type's name, version and options, with defaults filled in: shapes of equal hash are the same mesh.
uint64_t hash_shape(const LibraryGrain& grain, const ShapeOptions& options);

} // namespace scree
