#include "tests/builders/grain_beds.h"

#include "base/warp.h"
#include "render/grains/library/grain_library.h"
#include "render/gsdf/gsdf_builder.h"
#include "tests/builders/shapes.h"

#include <tbb/parallel_for.h>

#include <map>

namespace scree {

namespace {

std::unique_ptr<TestScene> lay(const BedGrain& grain, double fraction, uint64_t count)
{
    auto scene = std::make_unique<TestScene>();
    const uint32_t type = scene->add_type(grain.material, grain.shape);
    scene->set_gsdf(type, grain.gsdf);
    static std::map<std::pair<double, uint64_t>, std::vector<PackedSphere>>
        packings; // costly, and the same for every grain
    auto& packing = packings[{fraction, count}];
    if (packing.empty()) packing = push_apart(count, fraction, 1, 1e-3, 11);
    scene->add_grains(packing, type);
    return scene;
}

Light sky(float top, float bottom)
{
    std::vector<Color> texels(32 * 16, Color(bottom));
    std::fill(texels.begin(), texels.begin() + 32 * 8, Color(top));
    Light light;
    light.kind = LightKind::environment;
    light.map = std::make_shared<EnvironmentMap>(texels, 32, 16, V3d(0, 0, 1), Color(1));
    return light;
}

} // namespace

std::vector<BedGrain> bed_grains(double gsdf_error)
{
    static const EmbreeDevice device;
    Material tea = dielectric(1.5);
    tea.absorption = Color(0.05f, 0.2f, 0.8f);
    std::vector<BedGrain> grains{
        {"glass spheres", dielectric(1.5), nullptr, nullptr},
        {"tea glass spheres", tea, nullptr, nullptr},
        {"white 0.9 spheres", lambert(0.9f), nullptr, nullptr},
        {"glass cubes", dielectric(1.5), std::make_shared<Exemplar>(device, cube(), "cube"), nullptr}};
    for (const char* name : {"sugar", "flour"}) {
        const LibraryGrain& grain = *find_library_grain(name);
        Material material = grain.material;
        material.absorption *= static_cast<float>(grain.typical_radius);
        grains.push_back({name, material,
                          std::make_shared<Exemplar>(device, make_grain_shape(grain, {0, 2000, {}}, name), name),
                          nullptr});
    }
    for (BedGrain& grain : grains) {
        if (grain.name == "tea glass spheres")
            grain.gsdf = grains[0].gsdf; // one precomputation serves every colour
        else
            grain.gsdf = build_gsdf({grain.shape.get(), grain.material}, {gsdf_error});
    }
    return grains;
}

std::unique_ptr<TestScene> make_bed(const BedGrain& grain, double fraction, uint64_t count)
{
    auto scene = lay(grain, fraction, count);
    scene->add_light(sky(1, 0));
    scene->build();
    return scene;
}

std::unique_ptr<TestScene> make_bed_under_sun(const BedGrain& grain, double fraction, uint64_t count, double diameter)
{
    auto scene = lay(grain, fraction, count);
    scene->add_light(sky(0.3f, 0.1f));
    Light sun;
    sun.kind = LightKind::distant;
    sun.direction = V3d(0.5, 0.3, 0.8).normalized();
    sun.one_minus_cos = 2 * std::pow(std::sin(diameter * pi / 720), 2);
    sun.radiance = Color(static_cast<float>(3 / (pi * sun.one_minus_cos * (2 - sun.one_minus_cos))));
    scene->add_light(sun);
    scene->build();
    return scene;
}

Estimate bed_radiance(const TestScene& bed, uint32_t paths, uint32_t explicit_grains, uint64_t seed)
{
    std::vector<double> values(paths);
    PathOptions options;
    options.explicit_grains = explicit_grains;
    tbb::parallel_for(uint32_t{0}, paths, [&](uint32_t p) {
        flush_subnormals();
        Sampler sampler(seed, p, 0, 0);
        const double u1 = sampler.next(), u2 = sampler.next();
        V3d o = 4.0 * sample_sphere(u1, u2);
        o.z = std::abs(o.z);
        const double u3 = sampler.next(), u4 = sampler.next(), u5 = sampler.next();
        const V3d target = 0.5 * V3d(u3, u4, u5) - V3d(0.25);
        values[p] = trace_path(bed.world(), bed.tracer(), o, (target - o).normalized(), sampler, options).radiance.z;
    });
    Estimate radiance;
    for (const double value : values) radiance.add(value);
    return radiance;
}

} // namespace scree
