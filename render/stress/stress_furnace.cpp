// The white furnace: lossless objects in surroundings of radiance 1 are invisible.

#include "render/stress/stress_furnace.h"

#include "render/stress/stress_scenes.h"

#include <fmt/format.h>

namespace scree {

namespace {

/// White surroundings made of two half skies that are sampled, so that scattering must weight light samples correctly.
StressFinding sampled_furnace(StressScene scene, const StressView& view, const Progress& progress)
{
    scene.description.lights.clear();
    for (const double z : {-1.0, 1.0}) {
        LightDescription half;
        half.kind = LightDescription::Kind::distant;
        half.direction = V3d(0.1, 0.2, 1) * z;
        half.irradiance = Color(static_cast<Real>(pi));
        half.angle = 180;
        scene.description.lights.push_back(half);
    }
    const StressPicture picture = StressStage(scene, {}, view, progress).render(view, progress);
    StressFinding finding = compare_truth(picture.film, std::vector<double>(picture.film.pixels().size(), 1), 4);
    finding.count(picture.statistics);
    return finding;
}

struct Kind {
    std::string name;
    Material material;
    std::string mesh;
};

const std::vector<Kind>& kinds()
{
    static const std::vector<Kind> all{{"white spheres", lambert_material(Color(1)), ""},
                                       {"glass spheres", glass_material(1.5), ""},
                                       {"rough glass spheres", glass_material(1.5, 0.5), ""},
                                       {"white cubes", lambert_material(Color(1)), "cube.obj"},
                                       {"glass cubes", glass_material(1.5), "cube.obj"},
                                       {"rough glass cubes", glass_material(1.5, 0.5), "cube.obj"}};
    return all;
}

StressScene bed_of(const Kind& kind, const Progress& progress)
{
    StressScene scene = bed_scene({kind.material}, progress);
    if (!kind.mesh.empty()) {
        scene.meshes[kind.mesh] = cube_mesh(1);
        scene.description.types[0].mesh = kind.mesh;
    }
    scene.description.film.width = 16;
    scene.description.film.height = 12;
    return scene;
}

} // namespace

StressFinding furnace(StressScene scene, const StressView& view, const Progress& progress, double allowed)
{
    scene.description.lights.clear();
    add_constant(scene, Color(1));
    const StressPicture picture = StressStage(scene, {}, view, progress).render(view, progress);
    StressFinding finding = compare_exactly(picture.film, 1, allowed);
    finding.count(picture.statistics);
    finding.remark += fmt::format("{:.3g} vertices a path, longest {}", finding.length(), finding.longest);
    return finding;
}

void add_furnace_cases(StressRun& run)
{
    run.begin("white furnace", "every pixel of 2,400 lossless grains in surroundings of radiance 1, compared with 1",
              "1e-5: the rounding of some 100 float products");
    for (const IntegratorKind integrator : all_kinds) {
        for (const Kind& kind : kinds()) {
            const bool quick = kind.mesh.empty() && integrator == IntegratorKind::ept;
            run.add(fmt::format("{}, {}", kind.name, name_of(integrator)),
                    quick ? StressExtent::quick : StressExtent::full, [&] {
                        return furnace(bed_of(kind, run.progress()),
                                       {.kind = integrator, .accuracy = Accuracy::draft, .spp = 8}, run.progress());
                    });
        }
    }

    run.begin("white furnace, indices", "the same for extreme indices of refraction and roughnesses",
              "1e-5: the rounding of some 100 float products");
    for (const double ior : {0.1, 1.0001, 4.0, 10.0}) {
        for (const double roughness : {0.0, 0.05, 1.0}) {
            run.add(fmt::format("index {}, roughness {}, ept", ior, roughness),
                    ior == 4 ? StressExtent::quick : StressExtent::full, [&] {
                        return furnace(bed_of({"", glass_material(ior, roughness), ""}, run.progress()), {.spp = 8},
                                       run.progress());
                    });
        }
        for (const char* mesh : {"", "cube.obj"}) {
            run.add(fmt::format("index {}, {}, ppt", ior, *mesh ? "cubes" : "spheres"), StressExtent::full, [&] {
                return furnace(bed_of({"", glass_material(ior), mesh}, run.progress()),
                               {.kind = IntegratorKind::ppt, .accuracy = Accuracy::draft, .spp = 8}, run.progress());
            });
        }
    }

    run.begin("white furnace, sampled", "the same with surroundings that are sampled; compares means", "noise");
    for (const IntegratorKind integrator : all_kinds) {
        for (const Kind& kind : kinds()) {
            const bool quick = integrator == IntegratorKind::ept && kind.name == "rough glass spheres";
            run.add(fmt::format("{}, {}", kind.name, name_of(integrator)),
                    quick ? StressExtent::quick : StressExtent::full, [&] {
                        return sampled_furnace(bed_of(kind, run.progress()),
                                               {.kind = integrator, .accuracy = Accuracy::draft, .spp = 256},
                                               run.progress());
                    });
        }
    }
}

} // namespace scree
