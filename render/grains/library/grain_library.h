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
    uint32_t version; ///< counts the changes of its generator and defaults: part of what caches are keyed by
};

/// The fourteen grain types of Mueller et al. 2016 by our own generators; shapes, materials and their sources are
/// listed in render/grains/library/README.md.
const std::vector<LibraryGrain>& grain_library();

/// nullptr if there is none of that name.
const LibraryGrain* find_library_grain(std::string_view name);

/// As find_library_grain, but throws InputError with the nearest name; place: what asked for it.
const LibraryGrain& require_library_grain(const std::string& name, const std::string& place);

/// Which individual of a type, and how finely.
struct ShapeOptions {
    uint64_t seed = 0;
    uint64_t triangles = 0; ///< 0: the type's default
    std::map<std::string, double> parameters;
};

inline constexpr uint64_t least_shape_triangles = 20, most_shape_triangles = 4'000'000;

/// The mesh of a library grain, scaled into the unit bounding sphere, oriented outwards, of `triangles` faces within 20
/// % (for a type that is the sphere itself 20,000 if 0).
///
/// Dielectrics are closed and do not intersect themselves. Throws InputError naming `place` for an unknown parameter or
/// a value out of range.
TriangleMesh make_grain_shape(const LibraryGrain& grain, const ShapeOptions& options, const std::string& place);

/// A parameter of a type's generator.
struct ShapeParameter {
    std::string name;
    double value, least, most; ///< value: the default
    std::string what;
};
const std::vector<ShapeParameter>& shape_parameters(const LibraryGrain& grain);

/// Of a type's version and options, canonical: two shapes of one hash are the same mesh.
uint64_t hash_shape(const LibraryGrain& grain, const ShapeOptions& options);

} // namespace scree
