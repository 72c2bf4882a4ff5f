#include "render/stress/stress_scene.h"

#include "base/error.h"
#include "ingest/meshes/write_mesh.h"
#include "packing/tiles/tile_generator.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace scree {

namespace {

using nlohmann::json;

json numbers(const V3d& v) { return {v.x, v.y, v.z}; }
template <class T>
json numbers(const Imath::Color3<T>& c)
{
    return {c.x, c.y, c.z};
}

json material_json(const Material& material, double scale)
{
    const double roughness = std::sqrt(material.alpha);
    switch (material.kind) {
    case MaterialKind::lambert: return {{"kind", "lambert"}, {"reflectance", numbers(material.reflectance)}};
    case MaterialKind::dielectric:
        return {
            {"kind", "dielectric"},
            {"ior", material.ior},
            {"roughness", roughness},
            {"tint", numbers(material.tint)},
            {"absorption", numbers(V3d(material.absorption.x, material.absorption.y, material.absorption.z) / scale)}};
    case MaterialKind::conductor:
        return {{"kind", "conductor"},
                {"eta", numbers(material.eta)},
                {"k", numbers(material.k)},
                {"roughness", roughness},
                {"tint", numbers(material.tint)}};
    }
    return {};
}

json camera_json(const CameraDescription& camera, const Placing& placing)
{
    json out{{"origin", numbers(placing.point(camera.origin))},
             {"target", numbers(placing.point(camera.target))},
             {"up", numbers(placing.direction(camera.up))},
             {"aperture", placing.length(camera.aperture)},
             {"focus", placing.length(camera.focus)}};
    if (camera.kind == CameraKind::perspective) {
        out["fov"] = camera.fov;
    } else {
        out["kind"] = "orthographic";
        out["width"] = placing.length(camera.width);
    }
    return out;
}

json light_json(const LightDescription& light, const Placing& placing)
{
    using Kind = LightDescription::Kind;
    switch (light.kind) {
    case Kind::constant: return {{"kind", "constant"}, {"radiance", numbers(light.radiance)}};
    case Kind::environment:
        return {{"kind", "environment"}, {"file", light.file.string()}, {"up", numbers(placing.direction(light.up))}};
    case Kind::distant:
        return {{"kind", "distant"},
                {"direction", numbers(placing.direction(light.direction))},
                {"irradiance", numbers(light.irradiance)},
                {"angle", light.angle}};
    case Kind::rectangle:
        return {{"kind", "rectangle"},
                {"corner", numbers(placing.point(light.corner))},
                {"radiance", numbers(light.radiance)},
                {"edges", {numbers(placing.vector(light.edge1)), numbers(placing.vector(light.edge2))}}};
    case Kind::sphere:
        return {{"kind", "sphere"},
                {"center", numbers(placing.point(light.center))},
                {"radius", placing.length(light.radius)},
                {"radiance", numbers(light.radiance)}};
    }
    return {};
}

json grains_json(const StressScene& scene, const Placing& placing)
{
    json types, numbered;
    for (size_t i = 0; i < scene.description.types.size(); ++i) {
        const GrainTypeDescription& type = scene.description.types[i];
        const json shape = type.mesh ? json{{"mesh", type.mesh->string()}} : json("sphere");
        types[type.name] = {{"shape", shape}, {"material", material_json(type.material, placing.scale)}};
        numbered[std::to_string(i + 1)] = type.name;
    }
    json assembly{{"types", numbered}};
    if (scene.tile) {
        assembly["fill"] = scene.filled;
        assembly["tile"] = "tile.vdb";
        assembly["radius"] = placing.length(scene.fill_radius);
    } else {
        assembly["dump"] = "grains.dump";
    }
    return {{"types", types}, {"assembly", assembly}};
}

json scene_json(const StressScene& scene, const Placing& placing)
{
    const SceneDescription& d = scene.description;
    json out{{"camera", camera_json(d.camera, placing)},
             {"film", {{"size", {d.film.width, d.film.height}}, {"filter", "box"}}}};
    for (const LightDescription& light : d.lights) out["lights"].push_back(light_json(light, placing));
    for (const SurfaceDescription& surface : d.surfaces) {
        out["surfaces"].push_back(
            {{"mesh", surface.mesh.string()}, {"material", material_json(surface.material, placing.scale)}});
    }
    for (const MediumDescription& medium : d.media) {
        const V3d sigma(medium.sigma_t.x, medium.sigma_t.y, medium.sigma_t.z);
        out["medium"].push_back({{"mesh", medium.mesh.string()},
                                 {"sigma_t", numbers(sigma / placing.scale)},
                                 {"albedo", numbers(medium.albedo)},
                                 {"g", medium.g}});
    }
    if (!d.types.empty()) out["grains"] = grains_json(scene, placing);
    return out;
}

void write_text(const std::filesystem::path& path, const std::string& text)
{
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.close();
    if (!out)
        throw InputError(path.string(), "a file that cannot be written", "room for the scenes of the stress test");
}

std::string dump_text(const StressScene& scene, const Placing& placing)
{
    V3d lo(0), hi(0);
    std::string rows;
    for (size_t i = 0; i < scene.grains.size(); ++i) {
        const StressGrain& grain = scene.grains[i];
        const V3d c = placing.point(grain.center);
        const double r = placing.length(grain.radius);
        for (int a = 0; a < 3; ++a) {
            lo[a] = i == 0 ? c[a] - 2 * r : std::min(lo[a], c[a] - 2 * r);
            hi[a] = i == 0 ? c[a] + 2 * r : std::max(hi[a], c[a] + 2 * r);
        }
        const Imath::Quatd q = placing.rotation * grain.orientation;
        rows += fmt::format("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", i + 1,
                            grain.type + 1, c.x, c.y, c.z, r, q.r, q.v.x, q.v.y, q.v.z);
    }
    std::string text =
        fmt::format("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n", scene.grains.size());
    for (int a = 0; a < 3; ++a) text += fmt::format("{:.17g} {:.17g}\n", lo[a], hi[a]);
    return text + "ITEM: ATOMS id type x y z radius quatw quati quatj quatk\n" + rows;
}

} // namespace

V3d Placing::direction(const V3d& v) const
{
    if (rotation.v == V3d(0)) return v; // exact
    const V3d across = rotation.v.cross(v);
    return v + 2.0 * (rotation.r * across + rotation.v.cross(across));
}

std::filesystem::path write_stress_scene(const StressScene& scene, const Placing& placing,
                                         const std::filesystem::path& folder)
{
    for (const auto& [name, mesh] : scene.meshes) {
        TriangleMesh placed = mesh;
        const bool is_shape = std::ranges::any_of(
            scene.description.types, [&](const GrainTypeDescription& type) { return type.mesh && *type.mesh == name; });
        if (!is_shape) {
            for (V3d& p : placed.positions) p = placing.point(p);
        }
        write_mesh(folder / name, placed);
    }
    if (scene.tile) write_tile(*scene.tile, folder / "tile.vdb");
    if (!scene.grains.empty() || scene.has_dump) write_text(folder / "grains.dump", dump_text(scene, placing));
    const std::filesystem::path path = folder / "scene.json";
    write_text(path, scene_json(scene, placing).dump(1));
    return path;
}

std::vector<V3d> packed_spheres(double fraction, uint64_t count, int copies, const Progress& progress)
{
    TileOptions options;
    options.fraction = fraction;
    options.variants = 1;
    options.seed = 8;
    options.sweeps = 0;
    const PackingTile tile = make_tile(std::vector<double>(count, 1.0), options, progress).tile;
    const double unit = 1 / double{tile.radius[0]}, edge = tile.size.x * unit;
    std::vector<V3d> places;
    for (int z = 0; z < copies; ++z) {
        for (int y = 0; y < copies; ++y) {
            for (int x = 0; x < copies; ++x) {
                for (const V3d& place : tile.variants[0]) {
                    V3d p = place * unit + V3d(x, y, z) * edge - V3d(0.5 * copies * edge);
                    for (int a = 0; a < 3; ++a) p[a] = std::round(p[a] * 0x1p20) * 0x1p-20;
                    places.push_back(p);
                }
            }
        }
    }
    return places;
}

std::vector<V3d> fcc_spheres(int cells)
{
    const double edge = 2 * std::sqrt(2.0);
    std::vector<V3d> places;
    for (int z = 0; z < cells; ++z) {
        for (int y = 0; y < cells; ++y) {
            for (int x = 0; x < cells; ++x) {
                const V3d corner = V3d(x, y, z) * edge - V3d(0.5 * cells * edge);
                for (const V3d& face : {V3d(0, 0, 0), V3d(0.5, 0.5, 0), V3d(0.5, 0, 0.5), V3d(0, 0.5, 0.5)})
                    places.push_back(corner + face * edge);
            }
        }
    }
    return places;
}

Material lambert_material(const Color& reflectance)
{
    Material material;
    material.reflectance = reflectance;
    return material;
}

Material glass_material(double ior, double roughness, const Color& absorption)
{
    Material material;
    material.kind = MaterialKind::dielectric;
    material.ior = ior;
    material.alpha = roughness * roughness;
    material.absorption = absorption;
    return material;
}

} // namespace scree
