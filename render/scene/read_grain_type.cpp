#include "render/scene/read_grain_type.h"

#include <fmt/format.h>

namespace scree {

namespace {

std::vector<std::string> library_names()
{
    std::vector<std::string> names;
    for (const LibraryGrain& grain : grain_library()) names.push_back(grain.name);
    return names;
}

/// A shape given by its name only: the sphere, or a grain of the library.
void read_named_shape(const JsonValue& shape, GrainTypeDescription& type)
{
    if (!shape.is_string()) shape.fail("\"sphere\", a name of the library, {\"mesh\": FILE} or {\"library\": NAME}");
    const std::string name = shape.string();
    if (name == "sphere") return;
    type.library = find_library_grain(name);
    if (type.library) return;
    std::vector<std::string> names = library_names();
    names.insert(names.begin(), "sphere");
    const std::string nearest = did_you_mean(name, names);
    shape.fail(
        fmt::format("\"sphere\", {{\"mesh\": FILE}} or a grain of the library: {}", fmt::join(library_names(), ", ")),
        nearest.empty() ? "" : nearest.substr(2));
}

/// {"library": NAME, "triangles", "seed", "parameters"}
void read_library_shape(const JsonValue& json, GrainTypeDescription& type)
{
    JsonObject object = json.object();
    type.library = find_library_grain(library_names()[object.require("library").choice(library_names())]);
    if (const auto triangles = object.find("triangles")) {
        type.shape.triangles = static_cast<uint64_t>(triangles->integer(least_shape_triangles, most_shape_triangles));
    }
    if (const auto seed = object.find("seed"))
        type.shape.seed = static_cast<uint64_t>(seed->integer(0, std::numeric_limits<int64_t>::max()));
    if (const auto parameters = object.find("parameters")) {
        JsonObject entries = parameters->object();
        for (const ShapeParameter& parameter : shape_parameters(*type.library)) {
            if (const auto value = entries.find(parameter.name))
                type.shape.parameters[parameter.name] = value->number(parameter.least, parameter.most);
        }
        entries.done();
    }
    object.done();
}

} // namespace

GrainTypeDescription read_grain_type(const std::string& name, const JsonValue& json, double metres_per_unit)
{
    JsonObject object = json.object();
    GrainTypeDescription type;
    type.name = name;
    type.place = json.place();
    const JsonValue shape = object.require("shape");
    if (!shape.is_object()) {
        read_named_shape(shape, type);
    } else if (shape.object().find("library")) {
        read_library_shape(shape, type);
    } else {
        JsonObject mesh = shape.object();
        type.mesh = mesh.require("mesh").path();
        mesh.done();
    }
    if (type.library) {
        type.material = type.library->material;
        type.material.absorption *= static_cast<float>(metres_per_unit);
        if (const auto material = object.find("material")) type.material = read_material(*material);
    } else {
        type.material = read_material(object.require("material"));
    }
    object.done();
    return type;
}

double read_unit(const JsonValue& json)
{
    if (json.is_string()) {
        static const std::vector<std::pair<std::string, double>> metres{
            {"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}};
        std::vector<std::string> names;
        for (const auto& [name, length] : metres) names.push_back(name);
        return metres[json.choice(names)].second;
    }
    if (!json.is_number()) json.fail("metres per unit of length, or \"m\", \"cm\", \"mm\", \"um\"");
    const double unit = json.number(0, 1e30);
    if (unit <= 0) json.fail("a number above 0");
    return unit;
}

} // namespace scree
