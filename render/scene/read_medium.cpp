#include "render/scene/read_medium.h"

#include <cmath>

namespace scree {

namespace {

constexpr double largest = std::numeric_limits<float>::max(); // of values that are stored as float

} // namespace

MediumDescription read_medium(const JsonValue& json)
{
    JsonObject object = json.object();
    MediumDescription medium;
    const auto mesh = object.find("mesh"), vdb = object.find("vdb");
    if (mesh.has_value() == vdb.has_value()) {
        json.fail("either the key 'mesh', a closed surface with the same medium everywhere, or 'vdb', a file of a "
                  "medium that varies",
                  R"({"mesh": "slab.off", "sigma_t": 1} or {"vdb": "cloud.vdb", "scale": 10})");
    }
    if (mesh) {
        medium.mesh = mesh->path();
        medium.sigma_t = object.require("sigma_t").rgb(0, largest);
    } else {
        medium.vdb = vdb->path();
        if (const auto density = object.find("density")) medium.density = density->string();
        if (const auto scale = object.find("scale")) medium.sigma_t = scale->rgb(0, largest);
        if (const auto interpolation = object.find("interpolation"))
            medium.nearest = interpolation->choice({"linear", "nearest"}) == 1;
    }
    if (const auto albedo = object.find("albedo")) {
        if (albedo->is_string() && vdb)
            medium.albedo_grid = albedo->string();
        else
            medium.albedo = albedo->rgb(0, 1);
    }
    if (const auto g = object.find("g")) {
        if (g->is_string() && vdb)
            medium.g_grid = g->string();
        else if (medium.g = g->number(-1, 1); std::abs(medium.g) == 1)
            g->fail("a number above -1 and below 1"); // the phase function would have no density
    }
    object.done();
    return medium;
}

} // namespace scree
