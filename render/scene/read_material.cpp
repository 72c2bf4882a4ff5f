#include "base/json.h"
#include "render/scene/scene_description.h"

namespace scree {

namespace {

const EnumNames<MaterialKind> material_names{{MaterialKind::lambert, "lambert"},
                                             {MaterialKind::dielectric, "dielectric"},
                                             {MaterialKind::conductor, "conductor"}};

constexpr double largest = std::numeric_limits<float>::max(); // of values that are stored as float

/// The GGX width of a roughness 0..1: its square, as in Blender and glTF.
double read_alpha(JsonObject& object)
{
    const auto roughness = object.find("roughness");
    if (!roughness) return 0;
    const double r = roughness->number(0, 1);
    return r * r;
}

Color read_rgb(JsonObject& object, const std::string& key, const Color& absent, double lo, double hi)
{
    const auto value = object.find(key);
    return value ? Color(value->rgb(lo, hi)) : absent;
}

} // namespace

Material read_material(const JsonValue& json)
{
    JsonObject object = json.object();
    Material material;
    material.kind = object.require("kind").choice(material_names);
    switch (material.kind) {
    case MaterialKind::lambert:
        material.reflectance = read_rgb(object, "reflectance", material.reflectance, 0, 1);
        break;
    case MaterialKind::dielectric: {
        const auto ior = object.find("ior");
        if (ior) material.ior = ior->number(0.1, 10);
        material.alpha = read_alpha(object);
        material.absorption = read_rgb(object, "absorption", Color(0), 0, largest);
        material.tint = read_rgb(object, "tint", Color(1), 0, 1);
        if (material.ior == 1) material.alpha = 0; // without an interface there is no roughness
        break;
    }
    case MaterialKind::conductor:
        material.eta = object.require("eta").rgb(0, largest);
        material.k = object.require("k").rgb(0, largest);
        material.alpha = read_alpha(object);
        material.tint = read_rgb(object, "tint", Color(1), 0, 1);
        break;
    }
    object.done();
    return material;
}

} // namespace scree
