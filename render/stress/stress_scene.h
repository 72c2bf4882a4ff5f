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

/// A row of the dump of a stress scene; type: place of its grain type in the list.
struct StressGrain {
    V3d center;
    double radius = 1;
    size_t type = 0;
    Imath::Quatd orientation{1, 0, 0, 0};
};

/// A scene as a user would write it, before it is put anywhere: paths in `description` are names of `meshes`.
struct StressScene {
    SceneDescription description; ///< without assembly
    std::map<std::string, TriangleMesh> meshes;
    std::vector<StressGrain> grains; ///< written as a LAMMPS dump
    bool has_dump = false; ///< write the dump though it has no grain

    std::shared_ptr<const PackingTile> tile; ///< with it grains are a fill of `filled`,
    std::string filled;
    double fill_radius = 0; ///< of this mean radius
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

/// Spheres of radius 1 of a random packing, `copies`^3 copies of a periodic cube of `count`, around the origin.
///
/// fraction: of the volume, up to 0.6. Coordinates are multiples of 2^-20, so that they can be moved by 1e7 without
/// loss.
std::vector<V3d> packed_spheres(double fraction, uint64_t count, int copies, const Progress& progress);
/// Touching spheres of radius 1 on a face-centred cubic lattice, f = 0.74: `cells`^3 cubes of four.
std::vector<V3d> fcc_spheres(int cells);

Material lambert_material(const Color& reflectance);
Material glass_material(double ior, double roughness = 0, const Color& absorption = Color(0));

} // namespace scree
