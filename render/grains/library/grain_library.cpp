#include "render/grains/library/grain_library.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/text.h"
#include "ingest/meshes/enclosing_sphere.h"
#include "render/grains/library/radial_surface.h"
#include "render/grains/library/shape_generator.h"

#include <fmt/format.h>

#include <bit>

namespace scree {

namespace {

/// A library grain and how its shape is made.
struct Entry {
    LibraryGrain grain;
    ShapeGenerator generator;
    std::vector<ShapeParameter> parameters;
};

Material dielectric(double ior, double roughness, const Color& absorption_per_mm)
{
    Material material;
    material.kind = MaterialKind::dielectric;
    material.ior = ior;
    material.alpha = roughness * roughness;
    material.absorption = Real(1000) * absorption_per_mm;
    return material;
}

Material lambert(const Color& reflectance)
{
    Material material;
    material.kind = MaterialKind::lambert;
    material.reflectance = reflectance;
    return material;
}

TriangleMesh make_ball(const ShapeRequest& request)
{
    return radial_surface([](const V3d&) { return 1.0; }, request.triangles);
}

struct CrystalDefaults {
    double elongation, intergrown, chips, rounding, roughness;
};

std::vector<ShapeParameter> crystal(const CrystalDefaults& d)
{
    return {{"elongation", d.elongation, 0.5, 2, "length along the crystal's b axis, relative to the common habit"},
            {"variation", 0.14, 0, 0.3, "largest random change of each face's growth, as a fraction"},
            {"intergrown", d.intergrown, 1, 6, "crystals grown together"},
            {"chips", d.chips, 0, 30, "corners broken off each crystal"},
            {"chip_depth", 0.12, 0.005, 0.3, "greatest depth of the chips, in radii"},
            {"rounding", d.rounding, 0.002, 0.3, "wear of the edges: 1 / p of the p-norm over the faces"},
            {"roughness", d.roughness, 0, 0.1, "height of bumps, in radii"}};
}

struct PebbleDefaults {
    double middle_axis, short_axis, facets, angularity, breaks, break_depth, rounding, roughness, bump_size;
};

std::vector<ShapeParameter> pebble(const PebbleDefaults& d)
{
    return {{"middle_axis", d.middle_axis, 0.3, 1, "second axis divided by the longest"},
            {"short_axis", d.short_axis, 0.2, 1, "shortest axis divided by the longest"},
            {"facets", d.facets, 0, 60, "planes that cut the ellipsoid"},
            {"angularity", d.angularity, 0, 0.5, "greatest depth of the planes' cuts, in radii"},
            {"breaks", d.breaks, 0, 12, "conchoidal breaks"},
            {"break_depth", d.break_depth, 0, 0.3, "greatest depth of the breaks, in radii"},
            {"rounding", d.rounding, 0.005, 0.4, "wear of the edges between planes: 1 / p of the p-norm"},
            {"roughness", d.roughness, 0, 0.3, "height of bumps, in radii"},
            {"bump_size", d.bump_size, 0.05, 2, "size of the largest bumps, in radii"}};
}

const std::vector<ShapeParameter> cluster{
    {"granules", 170, 0, 400, "starch granules in the skin"},
    {"granule_size", 0.17, 0.03, 0.5, "radius of the largest granule, in radii of the lump"},
    {"lumpiness", 0.42, 0, 0.7, "height of the lump's own bumps, in radii"},
    {"lump_size", 0.6, 0.2, 2, "size of the lump's own bumps, in radii"},
    {"roughness", 0.02, 0, 0.1, "height of the finest bumps, in radii"}};

const std::vector<ShapeParameter> snowflake{
    {"plate", 0.2, 0.1, 0.4, "radius of the hexagon in the middle, relative to the length of an arm"},
    {"arm_width", 0.035, 0.015, 0.06, "half width of an arm, relative to its length"},
    {"branch_length", 0.5, 0.1, 0.8, "length of the longest branches, relative to an arm"},
    {"branches", 6, 0, 9, "branches on each side of an arm, if there are enough triangles"},
    {"twigs", 4, 0, 8, "twigs on each side of a branch, if there are enough triangles"},
    {"thickness", 0.035, 0.01, 0.2, "thickness of the plate at its rim, relative to the length of an arm"},
    {"ridge", 0.8, 0, 3, "added thickness of limbs along their middle, as a fraction of `thickness`"}};

const std::vector<ShapeParameter> fibre_ball{
    {"fibres", 200, 1, 2000, "number of fibres, if there are enough triangles"},
    {"thickness", 0.009, 0.002, 0.1, "radius of a fibre"},
    {"length", 7, 0.5, 30, "length of a fibre"},
    {"curliness", 2.5, 0, 10, "curvature of a fibre inside the ball"}};

const std::vector<ShapeParameter> bark_curl{
    {"length", 3.2, 0.5, 8, "length along the axis of the curl, in inner radii of the curl"},
    {"turns", 1.35, 0.1, 2.5, "turns of the curl"},
    {"opening", 0.42, 0.25, 1.5, "growth of the radius per turn"},
    {"thickness", 0.16, 0.02, 0.2, "thickness of the bark, in inner radii of the curl"},
    {"raggedness", 0.3, 0, 0.5, "raggedness of the torn edges"},
    {"roughness", 0.3, 0, 0.5, "depth of furrows, in thicknesses"}};

const std::vector<ShapeParameter> no_parameters;

constexpr double mm = 1e-3;

const std::vector<Entry>& entries()
{
    static const std::vector<Entry> all{
        {{"sugar", "granulated sugar: a chipped crystal of sucrose", dielectric(1.558, 0.2, {0.002f, 0.004f, 0.011f}),
          0.3 * mm, 20000, 1},
         make_crystal,
         crystal({1.15, 1, 5, 0.012, 0.006})},
        {{"brown_sugar", "brown sugar: small crystals grown together, coated with molasses",
          dielectric(1.558, 0.3, {0.2f, 0.4f, 1.1f}), 0.35 * mm, 20000, 1},
         make_crystal,
         crystal({1.0, 4, 3, 0.04, 0.02})},
        {{"ice", "crushed ice, its edges melted round", dielectric(1.31, 0, {0.00013f, 0.000055f, 0.000016f}), 2 * mm,
          40000, 1},
         make_pebble,
         pebble({0.85, 0.7, 14, 0.32, 3, 0.2, 0.03, 0.06, 0.9})},
        {{"snowflake", "snow crystal: a stellar dendrite", dielectric(1.31, 0, {0.00013f, 0.000055f, 0.000016f}),
          1 * mm, 20000, 1},
         make_snowflake,
         snowflake},
        {{"white_sand", "quartz sand, clear, its surface frosted", dielectric(1.545, 0.4, {0.06f, 0.075f, 0.11f}),
          0.25 * mm, 20000, 1},
         make_pebble,
         pebble({0.85, 0.7, 18, 0.36, 4, 0.16, 0.04, 0.1, 0.4})},
        {{"yellow_sand", "beach sand: quartz stained by goethite", dielectric(1.545, 0.45, {0.14f, 0.32f, 0.9f}),
          0.25 * mm, 20000, 1},
         make_pebble,
         pebble({0.82, 0.7, 12, 0.28, 2, 0.12, 0.09, 0.1, 0.4})},
        {{"brown_sand", "quartz and feldspar sand stained by iron oxides", dielectric(1.545, 0.5, {0.38f, 0.75f, 1.5f}),
          0.3 * mm, 20000, 1},
         make_pebble,
         pebble({0.8, 0.62, 16, 0.34, 4, 0.16, 0.04, 0.12, 0.45})},
        {{"dark_brown_sand", "sand of garnet, ilmenite and stained quartz", dielectric(1.62, 0.45, {1.3f, 2.1f, 3.1f}),
          0.25 * mm, 20000, 1},
         make_pebble,
         pebble({0.85, 0.72, 20, 0.32, 3, 0.14, 0.03, 0.1, 0.35})},
        {{"black_sand", "volcanic sand: basaltic glass", dielectric(1.6, 0.35, {6.0f, 6.3f, 6.6f}), 0.25 * mm, 20000,
          1},
         make_pebble,
         pebble({0.8, 0.65, 18, 0.36, 4, 0.18, 0.02, 0.12, 0.4})},
        {{"flour", "wheat flour: a lump of endosperm with starch granules", lambert({0.985f, 0.975f, 0.935f}),
          0.06 * mm, 20000, 1},
         make_cluster,
         cluster},
        {{"hairball", "wound hair: closed tubes that run through each other", lambert({0.5f, 0.34f, 0.23f}), 5 * mm,
          100000, 1},
         make_fibre_ball,
         fibre_ball},
        {{"cinnamon", "a curled piece of cinnamon bark", lambert({0.62f, 0.37f, 0.2f}), 0.5 * mm, 20000, 1},
         make_bark_curl,
         bark_curl},
        {{"dielectric_sphere", "the bounding sphere itself, of clear glass", dielectric(1.5, 0, Color(0.0f)), 0.5 * mm,
          0, 1},
         make_ball,
         no_parameters},
        {{"diffuse_sphere", "the bounding sphere itself, diffuse", lambert(Color(0.8f)), 0.5 * mm, 0, 1},
         make_ball,
         no_parameters}};
    return all;
}

const Entry& entry_of(const LibraryGrain& grain)
{
    for (const Entry& entry : entries()) {
        if (entry.grain.name == grain.name) return entry;
    }
    throw std::logic_error("a grain that is not the library's: " + grain.name);
}

uint64_t hash_name(std::string_view name)
{
    uint64_t hash = name.size();
    for (const char c : name) hash = mix64(hash ^ static_cast<unsigned char>(c));
    return hash;
}

/// Centres and scales the mesh so that its smallest enclosing sphere is the unit sphere.
void fit_into_unit_sphere(TriangleMesh& mesh)
{
    const auto [centre, radius] = smallest_enclosing_sphere(mesh.positions);
    for (V3d& p : mesh.positions) p = (p - centre) / radius;
}

} // namespace

const std::vector<LibraryGrain>& grain_library()
{
    static const std::vector<LibraryGrain> grains = [] {
        std::vector<LibraryGrain> list;
        for (const Entry& entry : entries()) list.push_back(entry.grain);
        return list;
    }();
    return grains;
}

const LibraryGrain* find_library_grain(std::string_view name)
{
    const auto& grains = grain_library();
    const auto found = std::ranges::find(grains, name, &LibraryGrain::name);
    return found == grains.end() ? nullptr : &*found;
}

const LibraryGrain& require_library_grain(const std::string& name, const std::string& place)
{
    if (const LibraryGrain* grain = find_library_grain(name)) return *grain;
    std::vector<std::string> names;
    for (const LibraryGrain& grain : grain_library()) names.push_back(grain.name);
    const std::string nearest = did_you_mean(name, names);
    throw InputError(place, in_quotes(name), "a grain of the library: " + join_words(names),
                     nearest.empty() ? "" : nearest.substr(2));
}

const std::vector<ShapeParameter>& shape_parameters(const LibraryGrain& grain) { return entry_of(grain).parameters; }

TriangleMesh make_grain_shape(const LibraryGrain& grain, const ShapeOptions& options, const std::string& place)
{
    const Entry& entry = entry_of(grain);
    ShapeRequest request;
    request.seed = mix64(options.seed ^ hash_name(grain.name));
    request.triangles = options.triangles > 0         ? options.triangles
                        : grain.default_triangles > 0 ? grain.default_triangles
                                                      : 20000;
    if (request.triangles < least_shape_triangles || request.triangles > most_shape_triangles) {
        throw InputError(place, fmt::format("{} triangles", request.triangles),
                         fmt::format("{} to {}", least_shape_triangles, most_shape_triangles));
    }
    std::vector<std::string> names;
    for (const ShapeParameter& parameter : entry.parameters) {
        request.parameters[parameter.name] = parameter.value;
        names.push_back(parameter.name);
    }
    for (const auto& [name, value] : options.parameters) {
        const auto known = std::ranges::find(entry.parameters, name, &ShapeParameter::name);
        if (known == entry.parameters.end()) {
            throw InputError(
                place, fmt::format("the unknown parameter '{}' of {}{}", name, grain.name, did_you_mean(name, names)),
                names.empty() ? "no parameters" : "one of " + join_words(names));
        }
        if (!(value >= known->least && value <= known->most)) {
            throw InputError(place, fmt::format("{} = {}", name, value),
                             fmt::format("{} to {}: {}", known->least, known->most, known->what));
        }
        request.parameters[name] = value;
    }
    TriangleMesh mesh = entry.generator(request);
    fit_into_unit_sphere(mesh);
    return mesh;
}

uint64_t hash_shape(const LibraryGrain& grain, const ShapeOptions& options)
{
    uint64_t hash = mix64(hash_name(grain.name) ^ grain.version);
    const uint64_t triangles = options.triangles > 0 ? options.triangles : grain.default_triangles;
    hash = mix64(mix64(hash ^ options.seed) + triangles);
    for (const ShapeParameter& parameter : shape_parameters(grain)) {
        const auto given = options.parameters.find(parameter.name);
        hash =
            mix64(hash ^ std::bit_cast<uint64_t>(given == options.parameters.end() ? parameter.value : given->second)) +
            hash_name(parameter.name);
    }
    return hash;
}

} // namespace scree
