#include "render/scene/scene_description.h"

#include "base/json.h"
#include "mixtures/read_mixture.h"
#include "render/scene/read_grain_type.h"
#include "render/scene/read_medium.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace scree {

namespace {

const EnumNames<CameraKind> camera_names{{CameraKind::perspective, "perspective"},
                                         {CameraKind::orthographic, "orthographic"}};
const EnumNames<FilterKind> filter_names{
    {FilterKind::box, "box"}, {FilterKind::tent, "tent"}, {FilterKind::gaussian, "gaussian"}};
const EnumNames<LightDescription::Kind> light_names{{LightDescription::Kind::constant, "constant"},
                                                    {LightDescription::Kind::environment, "environment"},
                                                    {LightDescription::Kind::distant, "distant"},
                                                    {LightDescription::Kind::rectangle, "rectangle"},
                                                    {LightDescription::Kind::sphere, "sphere"}};

constexpr double largest = std::numeric_limits<float>::max(); // of values that are stored as float

/// A number > 0.
double read_positive(const JsonValue& value)
{
    const double x = value.number(0, largest);
    if (x <= 0) value.fail("a number above 0");
    return x;
}

V3d read_direction(const JsonValue& value)
{
    const V3d v = value.vec3();
    if (!(v.length2() > 0)) value.fail("a direction that is not 0");
    return v;
}

CameraDescription read_camera(const JsonValue& json)
{
    JsonObject object = json.object();
    CameraDescription camera;
    if (const auto kind = object.find("kind")) camera.kind = kind->choice(camera_names);
    camera.origin = object.require("origin").vec3();
    const JsonValue target = object.require("target");
    camera.target = target.vec3();
    if (!((camera.target - camera.origin).length2() > 0)) target.fail("a target that differs from the origin");
    if (const auto up = object.find("up")) camera.up = read_direction(*up);
    if (!((camera.target - camera.origin).cross(camera.up).length2() > 0)) {
        throw InputError(json.place(), "an 'up' parallel to the view", "an 'up' not parallel to the view",
                         "set \"up\" to another axis");
    }
    if (camera.kind == CameraKind::perspective) {
        if (const auto fov = object.find("fov")) {
            camera.fov = read_positive(*fov);
            if (camera.fov >= 180) fov->fail("an angle below 180 degrees");
        }
    } else {
        camera.width = read_positive(object.require("width"));
    }
    if (const auto aperture = object.find("aperture")) camera.aperture = aperture->number(0);
    if (const auto focus = object.find("focus")) camera.focus = focus->number(0);
    object.done();
    return camera;
}

Filter read_filter(const JsonValue& json)
{
    Filter filter;
    const auto default_radius = [](FilterKind kind) {
        return kind == FilterKind::box ? 0.5 : kind == FilterKind::tent ? 1.0 : 1.5;
    };
    if (json.is_string()) {
        filter.kind = json.choice(filter_names);
        filter.radius = default_radius(filter.kind);
        return filter;
    }
    JsonObject object = json.object();
    filter.kind = object.require("kind").choice(filter_names);
    filter.radius = default_radius(filter.kind);
    if (const auto radius = object.find("radius")) filter.radius = read_positive(*radius);
    object.done();
    return filter;
}

FilmDescription read_film(const JsonValue& json)
{
    JsonObject object = json.object();
    FilmDescription film;
    if (const auto size = object.find("size")) {
        const auto items = size->array(2, 2);
        film.width = static_cast<int>(items[0].integer(1, 65536));
        film.height = static_cast<int>(items[1].integer(1, 65536));
    }
    if (const auto filter = object.find("filter")) film.filter = read_filter(*filter);
    if (const auto aov = object.find("aov")) {
        for (const JsonValue& name : aov->array()) {
            const Aov which = name.choice(aov_names);
            if (std::find(film.aov.begin(), film.aov.end(), which) == film.aov.end()) film.aov.push_back(which);
        }
    }
    object.done();
    return film;
}

LightDescription read_light(const JsonValue& json)
{
    using Kind = LightDescription::Kind;
    JsonObject object = json.object();
    LightDescription light;
    light.place = json.place();
    light.kind = object.require("kind").choice(light_names);
    const auto rgb = [&](const char* key, Color& value) {
        if (const auto found = object.find(key)) value = found->rgb(0, largest);
    };
    switch (light.kind) {
    case Kind::constant: rgb("radiance", light.radiance); break;
    case Kind::environment:
        light.file = object.require("file").path();
        rgb("scale", light.scale);
        if (const auto up = object.find("up")) light.up = read_direction(*up);
        break;
    case Kind::distant:
        light.direction = read_direction(object.require("direction"));
        rgb("irradiance", light.irradiance);
        if (const auto angle = object.find("angle")) light.angle = angle->number(0, 180);
        break;
    case Kind::rectangle: {
        light.corner = object.require("corner").vec3();
        const JsonValue edges = object.require("edges");
        const auto items = edges.array(2, 2);
        light.edge1 = items[0].vec3();
        light.edge2 = items[1].vec3();
        if (!(light.edge1.cross(light.edge2).length2() > 0)) edges.fail("two edges that span an area");
        rgb("radiance", light.radiance);
        break;
    }
    case Kind::sphere:
        light.center = object.require("center").vec3();
        light.radius = read_positive(object.require("radius"));
        rgb("radiance", light.radiance);
        break;
    }
    object.done();
    return light;
}

SurfaceDescription read_surface(const JsonValue& json)
{
    JsonObject object = json.object();
    SurfaceDescription surface{object.require("mesh").path(), read_material(object.require("material")), json.place()};
    object.done();
    return surface;
}

/// The type number of the dump in a JSON key.
int32_t read_type_number(const std::string& key, const JsonValue& where)
{
    int32_t number = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
    if (error != std::errc() || end != key.data() + key.size() || std::to_string(number) != key) {
        throw InputError(where.place(), "the key '" + key + "'", "a type number of the dump, e.g. \"1\"");
    }
    return number;
}

void check_type_name(const std::string& name, const std::vector<GrainTypeDescription>& types, const JsonValue& where)
{
    std::vector<std::string> names;
    for (const auto& type : types) names.push_back(type.name);
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    const std::string nearest = did_you_mean(name, names);
    where.fail(fmt::format("a grain type of the scene: {}", fmt::join(names, ", ")),
               nearest.empty() ? "" : nearest.substr(2));
}

/// Reads the map from type numbers of a dump or tile to grain types. by_type: whether each sphere must give its type,
/// because the mixture is explicit and has no map of its own.
void read_file_types(JsonObject& object, const std::vector<GrainTypeDescription>& types, bool by_type,
                     AssemblyDescription& assembly)
{
    if (const auto map = object.find("types")) {
        JsonObject entries = map->object();
        for (const std::string& key : entries.take_keys()) {
            const JsonValue name = entries.require(key);
            check_type_name(name.string(), types, name);
            assembly.types[read_type_number(key, *map)] = name.string();
        }
        if (assembly.types.empty()) map->fail("a grain type for at least one type of the file");
    } else if (by_type && types.size() != 1) {
        object.value().fail("the key 'types', which maps the file's types to grain types",
                            "e.g. \"types\": {\"1\": \"" + types[0].name + "\"}");
    }
}

void read_dump_radius(const JsonValue& radius, AssemblyDescription& assembly)
{
    if (radius.is_number()) {
        assembly.radius = read_positive(radius);
        return;
    }
    if (!radius.is_object()) radius.fail("a number above 0, or an object of radii by type of the dump");
    JsonObject entries = radius.object();
    for (const std::string& key : entries.take_keys()) {
        assembly.radius_of_type[read_type_number(key, radius)] = read_positive(entries.require(key));
    }
}

void read_listed_spheres(const JsonValue& list, const std::vector<GrainTypeDescription>& types, bool by_type,
                         AssemblyDescription& assembly)
{
    for (const JsonValue& item : list.array()) {
        JsonObject entry = item.object();
        AssemblyDescription::Sphere sphere{entry.require("center").vec3(), entry.require("radius").number(0, largest),
                                           ""};
        if (const auto type = entry.find("type")) {
            sphere.type = type->string();
            check_type_name(sphere.type, types, *type);
        } else if (by_type && types.size() != 1) {
            item.fail("the key 'type', because there are several grain types");
        }
        entry.done();
        assembly.spheres.push_back(sphere);
    }
}

AssemblyDescription read_assembly(const JsonValue& json, const std::vector<GrainTypeDescription>& types, bool by_type)
{
    JsonObject object = json.object();
    AssemblyDescription assembly;
    assembly.place = json.place();
    if (const auto dump = object.find("dump")) {
        assembly.dump = dump->path().string();
        read_file_types(object, types, by_type, assembly);
        if (const auto radius = object.find("radius")) read_dump_radius(*radius, assembly);
    } else if (const auto spheres = object.find("spheres")) {
        read_listed_spheres(*spheres, types, by_type, assembly);
    } else if (const auto mesh = object.find("fill")) {
        AssemblyDescription::Fill fill{mesh->path(), object.require("tile").path(),
                                       read_positive(object.require("radius"))};
        if (const auto seed = object.find("seed"))
            fill.seed = static_cast<uint64_t>(seed->integer(0, std::numeric_limits<int64_t>::max()));
        if (const auto repair = object.find("repair")) fill.repair = repair->boolean();
        read_file_types(object, types, by_type, assembly);
        assembly.fill = fill;
    } else {
        json.fail("an object with \"dump\", \"fill\" or \"spheres\"");
    }
    object.done();
    return assembly;
}

void read_grains(const JsonValue& json, SceneDescription& scene)
{
    JsonObject object = json.object();
    if (const auto unit = object.find("unit")) scene.metres_per_unit = read_unit(*unit);
    JsonObject types = object.require("types").object();
    for (const std::string& name : types.take_keys())
        scene.types.push_back(read_grain_type(name, types.require(name), scene.metres_per_unit));
    if (scene.types.empty()) types.value().fail("at least one grain type");
    std::vector<std::string> names;
    for (const GrainTypeDescription& type : scene.types) names.push_back(type.name);
    if (const auto mixture = object.find("mixture")) scene.mixture = read_mixture(*mixture, names);
    const auto* listed = std::get_if<ExplicitDescription>(&scene.mixture.kind);
    scene.assembly = read_assembly(object.require("assembly"), scene.types,
                                   listed && listed->types.empty() && listed->table.empty());
    object.done();
}

} // namespace

SceneDescription read_scene(const JsonDocument& document, const std::filesystem::path& file)
{
    SceneDescription scene;
    scene.file = file;
    scene.canonical = document.canonical();
    JsonObject object = document.root().object();
    if (const auto schema = object.find("$schema")) schema->string();
    scene.camera = read_camera(object.require("camera"));
    if (const auto film = object.find("film")) scene.film = read_film(*film);
    if (const auto lights = object.find("lights")) {
        for (const JsonValue& item : lights->array()) scene.lights.push_back(read_light(item));
    }
    if (const auto surfaces = object.find("surfaces")) {
        for (const JsonValue& item : surfaces->array()) scene.surfaces.push_back(read_surface(item));
    }
    if (const auto grains = object.find("grains")) read_grains(*grains, scene);
    if (const auto medium = object.find("medium")) {
        for (const JsonValue& item : medium->array()) scene.media.push_back(read_medium(item));
    }
    if (const auto integrator = object.find("integrator")) {
        scene.integrator = read_integrator(*integrator);
    }
    object.done();
    return scene;
}

} // namespace scree
