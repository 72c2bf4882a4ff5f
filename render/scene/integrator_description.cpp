#include "render/scene/integrator_description.h"

#include "base/json.h"

#include <limits>

namespace scree {

namespace {

constexpr double largest = std::numeric_limits<float>::max();
constexpr int64_t most_grains = 1000000000;

} // namespace

const std::vector<IntegratorKey>& integrator_keys()
{
    using Value = const JsonValue&;
    using Integrator = IntegratorDescription&;
    static const std::vector<IntegratorKey> keys{
        {"kind", "--integrator",
         "auto (combines the others according to the scene and --accuracy), ept (every grain as explicit geometry), "
         "ppt (grains averaged over rotations), vpt (a medium in place of the grains) or stf (the same, crossed in "
         "shells)",
         [](Value v, Integrator i) { i.kind = v.choice(integrator_names); }},
        {"accuracy", "--accuracy", "How far approximations may go: reference, high, standard or draft",
         [](Value v, Integrator i) { i.accuracy = v.choice(accuracy_names); }},
        {"explicit_grains", "--explicit-grains",
         "With auto and ppt: how many grains of a path are traced as explicit geometry (default: auto by --accuracy, "
         "ppt 0)",
         [](Value v, Integrator i) { i.explicit_grains = static_cast<uint32_t>(v.integer(0, most_grains)); }},
        {"grain_pixels", "--grain-pixels",
         "If the first grain of a path looks narrower than this many pixels, it and all later grains are proxies "
         "(default: 0, auto by --accuracy)",
         [](Value v, Integrator i) { i.grain_pixels = v.number(0, largest); }},
        {"grain_depth", "--grain-depth",
         "How many mean radii below every face a medium replaces the grains (default: auto by --accuracy, ept and ppt "
         "nowhere)",
         [](Value v, Integrator i) { i.grain_depth = v.number(0, largest); }},
        {"grain_flights", "--grain-flights",
         "The medium of the grains begins at least this many of its mean free paths below every face (default: 0, auto "
         "by --accuracy)",
         [](Value v, Integrator i) { i.grain_flights = v.number(0, largest); }},
        {"medium_form", "--medium-form",
         "How the medium of the grains is computed: plain, formula, walk or decay (default)",
         [](Value v, Integrator i) { i.medium_form = v.choice(medium_form_names); }},
        {"shells", "--shells", "Whether light crosses media in shells: on or off (default: on with auto and stf)",
         [](Value v, Integrator i) { i.shells = v.boolean(); }},
        {"stf_form", "--stf-form", "How light crosses a shell: full (default), cosine, hg, interpolated or diffusion",
         [](Value v, Integrator i) { i.stf_form = v.choice(stf_form_names); }},
        {"least_shell", "--least-shell",
         "A medium gets shells where the largest that fits has at least this many mean free paths (default: 1; auto 8, "
         "and in grids where shells save work)",
         [](Value v, Integrator i) { i.least_shell = v.number(0, largest); }},
        {"max_depth", "--max-depth",
         "Cut paths after this many scattering events (a shell is one); darkens the picture (default: never)",
         [](Value v, Integrator i) { i.max_depth = static_cast<uint32_t>(v.integer(1, most_grains)); }},
    };
    return keys;
}

IntegratorDescription read_integrator(const JsonValue& json)
{
    JsonObject object = json.object();
    IntegratorDescription integrator;
    for (const IntegratorKey& key : integrator_keys()) {
        if (const auto value = object.find(key.key)) key.read(*value, integrator);
    }
    object.done();
    return integrator;
}

} // namespace scree
