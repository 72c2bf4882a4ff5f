#pragma once

#include "base/progress.h"
#include "ingest/meshes/triangle_mesh.h"
#include "packing/tiles/packing_tile.h"
#include "render/scene/scene_description.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace scree {

/// A row of the dump of a stress scene; type: index of its grain type.
struct StressGrain {
    V3d center;
    double radius = 1;
    size_t type = 0;
    Imath::Quatd orientation{1, 0, 0, 0};
};

/// A scene as a user would write it, before it is placed: paths in `description` are names in `meshes`.
struct StressScene {
    SceneDescription description; ///< without assembly
    std::map<std::string, TriangleMesh> meshes;
    std::vector<StressGrain> grains; ///< written as a LAMMPS dump
    bool has_dump = false; ///< write the dump even if it has no grain

    std::shared_ptr<const PackingTile> tile; ///< if set, the grains are a fill made of it
    std::string filled; ///< name of the mesh that the fill fills
    double fill_radius = 0; ///< mean radius of the fill
};

/// Where a scene is put: turned, then scaled, then moved.
struct Placing {
    double scale = 1;
    V3d offset{0};
    Imath::Quatd rotation{1, 0, 0, 0}; ///< unit

    V3d direction(const V3d& v) const;
    V3d vector(const V3d& v) const { return direction(v) * scale; }
    V3d point(const V3d& p) const { return vector(p) + offset; }
    double length(double x) const { return x * scale; }
};

/// Writes scene.json, the dump, meshes and tile into `folder`, with all digits; returns the scene's path. Throws
/// InputError.
std::filesystem::path write_stress_scene(const StressScene& scene, const Placing& placing,
                                         const std::filesystem::path& folder);

/// A random packing of spheres of radius 1 around the origin: `copies`^3 copies of a periodic cube of `count` spheres.
///
/// fraction: the pack rate, up to 0.6. Coordinates are multiples of 2^-20, so that moving them by 1e7 loses nothing.
std::vector<V3d> packed_spheres(double fraction, uint64_t count, int copies, const Progress& progress);
/// Touching spheres of radius 1 on a face-centred cubic lattice, f = 0.74: `cells`^3 cubes of four.
std::vector<V3d> fcc_spheres(int cells);

Material lambert_material(const Color& reflectance);
Material glass_material(double ior, double roughness = 0, const Color& absorption = Color(0));

} // namespace scree
