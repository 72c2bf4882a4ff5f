#pragma once

#include "mixtures/mixture_description.h"
#include "render/film/aov.h"
#include "render/film/filter.h"
#include "render/grains/library/grain_library.h"
#include "render/materials/material.h"
#include "render/scene/camera.h"
#include "render/scene/integrator_description.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace scree {

class JsonDocument;

struct FilmDescription {
    int width = 640, height = 480;
    Filter filter;
    std::vector<Aov> aov;
};

/// A light of the scene file, in the scene's unit.
struct LightDescription {
    enum class Kind : uint8_t { constant, environment, distant, rectangle, sphere } kind = Kind::constant;
    Color radiance{1}; ///< constant, rectangle, sphere
    std::filesystem::path file; ///< environment
    Color scale{1}; ///< environment
    V3d up{0, 0, 1}; ///< environment
    V3d direction{0, 0, -1}; ///< distant: direction in which the light travels
    Color irradiance{1}; ///< distant: on a plane facing it
    double angle = 0.53; ///< distant: angular diameter, degrees
    V3d corner{0}, edge1{0}, edge2{0};
    V3d center{0};
    double radius = 0;
    std::string place; ///< in the scene file, for messages
};

struct SurfaceDescription {
    std::filesystem::path mesh;
    Material material; ///< absorption per unit of length of the scene
    std::string place;
};

struct GrainTypeDescription {
    std::string name;
    std::optional<std::filesystem::path> mesh; ///< the user's mesh
    const LibraryGrain* library = nullptr; ///< without triangles, or null and no mesh: a sphere
    ShapeOptions shape; ///< options of the library's mesh
    Material material; ///< absorption per unit of length of the scene
    std::string place;

    /// Whether the shape is a mesh rather than the bounding sphere.
    bool has_mesh() const { return mesh || (library && (library->default_triangles > 0 || shape.triangles > 0)); }
};

/// Where the grains come from: a dump, a mesh filled with a tile, or spheres listed in the scene.
struct AssemblyDescription {
    struct Sphere {
        V3d center;
        double radius;
        std::string type; ///< name of a grain type; empty: the only grain type
    };
    /// A mesh filled with the spheres of a repeated tile.
    struct Fill {
        std::filesystem::path mesh, tile;
        double radius = 0; ///< mean radius of the spheres
        uint64_t seed = 0; ///< chooses the tile's variant at each place
        bool repair = false;
    };
    std::string dump; ///< file, glob or printf pattern (or .vdb of points); empty without a dump
    std::optional<Fill> fill;
    std::map<int32_t, std::string> types; ///< type number in the dump or tile -> name of a grain type
    std::optional<double> radius; ///< for dumps without a radius column
    std::map<int32_t, double> radius_of_type;
    std::vector<Sphere> spheres;
    std::string place;
};

/// A medium named by the scene: uniform inside a mesh, or varying as given by a file of OpenVDB grids.
struct MediumDescription {
    std::filesystem::path mesh, vdb; ///< exactly one of them is set
    Color sigma_t{1}; ///< extinction per unit of length; vdb: where the density is 1
    Weight albedo{1};
    double g = 0; ///< mean cosine of the Henyey-Greenstein phase function
    std::string density = "density"; ///< vdb: names of grids
    std::string albedo_grid, g_grid; ///< vdb: empty if albedo or g is the same everywhere
    bool nearest = false; ///< vdb: no interpolation between voxels
};

/// A scene file, read and checked, with absolute paths; the files it names have not been opened yet.
struct SceneDescription {
    std::filesystem::path file;
    std::string canonical; ///< the JSON without layout, covered by the scene hash
    CameraDescription camera;
    FilmDescription film;
    std::vector<LightDescription> lights;
    std::vector<SurfaceDescription> surfaces;
    std::vector<GrainTypeDescription> types; ///< in order of name
    double metres_per_unit = 1e-3; ///< the scene's unit of length, for the library's materials
    std::optional<AssemblyDescription> assembly;
    MixtureDescription mixture{ExplicitDescription{}, {}, {}}; ///< gives each sphere its grain type
    std::vector<MediumDescription> media;
    IntegratorDescription integrator;
};

/// Checks and reads every key. Throws InputError that names the file and the JSON path.
SceneDescription read_scene(const JsonDocument& document, const std::filesystem::path& file);

/// A material from its JSON object (keys: render/scene/scene.schema.json). Throws InputError.
class JsonValue;
Material read_material(const JsonValue& json);

} // namespace scree
