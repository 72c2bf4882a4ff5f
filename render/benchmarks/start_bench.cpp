// The time to start: sets up ten opaque grains with `auto` and with `ept`, in turns.
// usage: start_bench [repetitions, 200 by default]

#include "base/json.h"
#include "render/build/world_builder.h"
#include "render/trace/tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace scree {
namespace {

SceneDescription ten_grains(const std::string& integrator)
{
    std::string spheres;
    for (int i = 0; i < 10; ++i)
        spheres +=
            fmt::format(R"({}{{"center": [{}, {}, 0], "radius": 0.25}})", i ? ", " : "", 0.5 * (i % 5), 0.5 * (i / 5));
    const std::string text =
        R"({"camera": {"origin": [0, -9, 5], "target": [0, 0, 0]}, "lights": [{"kind": "constant"}], )"
        R"("integrator": {"kind": ")" +
        integrator +
        R"("}, "grains": {"types": {"clay": {"shape": "sphere", "material": {"kind": "lambert"}}}, )"
        R"("assembly": {"spheres": [)" +
        spheres + "]}}}";
    return read_scene(JsonDocument::parse(text, "ten.json", "."), "ten.json");
}

/// Seconds from the scene description to the first ray.
double setup_seconds(const SceneDescription& scene)
{
    const Stopwatch watch;
    WorldBuilder builder(scene);
    const auto world = builder.build(0).world;
    const Tracer tracer(builder.device(), *world);
    return watch.seconds();
}

double quantile(std::vector<double> values, double part)
{
    std::ranges::sort(values);
    return values[static_cast<size_t>(part * static_cast<double>(values.size() - 1))];
}

} // namespace
} // namespace scree

int main(int argc, char** argv)
{
    using namespace scree;
    const int repetitions = argc > 1 ? std::max(1, std::atoi(argv[1])) : 200;
    const SceneDescription automatic = ten_grains("auto"), ept = ten_grains("ept");
    std::vector<double> a, e;
    setup_seconds(automatic); // the first loads Embree's code
    for (int i = 0; i < repetitions; ++i) {
        const bool first = i % 2 == 0;
        if (first) a.push_back(setup_seconds(automatic));
        e.push_back(setup_seconds(ept));
        if (!first) a.push_back(setup_seconds(automatic));
    }
    for (const auto& [name, values] : {std::pair{"auto", a}, {"ept", e}}) {
        fmt::print("{:<5} {:.3f} ms, quartiles {:.3f} to {:.3f}\n", name, 1e3 * quantile(values, 0.5),
                   1e3 * quantile(values, 0.25), 1e3 * quantile(values, 0.75));
    }
    fmt::print("ratio of medians {:.3f}\n", quantile(a, 0.5) / quantile(e, 0.5));
    return 0;
}
