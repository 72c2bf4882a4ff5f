// Grains of twelve decades of size in one scene. Four grains of each decade lie around the middle, at distances that
// grow with their radius: the scene looks the same in every decade, ten times as large. The middle is a median of the
// grains, where positions keep their precision.

#include "render/stress/stress_furnace.h"
#include "render/stress/stress_scenes.h"

#include <fmt/format.h>

namespace scree {

namespace {

constexpr int least = -9, most = 3;

/// The scene seen from so near that it shows the grains of radius 10^decade.
StressScene decades(int decade, const std::vector<Material>& materials)
{
    StressScene scene = empty_scene(24, 24, V3d(0), V3d(1), 35);
    for (size_t i = 0; i < materials.size(); ++i) add_type(scene, "grain" + std::to_string(i), materials[i]);
    const V3d corners[] = {V3d(1, 1, 1), V3d(1, -1, -1), V3d(-1, 1, -1), V3d(-1, -1, 1)};
    for (int d = least; d <= most; ++d) {
        const double radius = std::pow(10.0, d);
        for (size_t i = 0; i < 4; ++i)
            scene.grains.push_back({corners[i] * (2.0 * radius), radius, i % materials.size(), {1, 0, 0, 0}});
    }
    const double size = std::pow(10.0, decade);
    scene.description.camera.kind = CameraKind::orthographic;
    scene.description.camera.origin = V3d(-0.3, -0.2, 9) * size;
    scene.description.camera.target = V3d(0);
    scene.description.camera.up = V3d(0, 1, 0);
    scene.description.camera.width = 8 * size;
    return scene;
}

StressFinding like_decade_zero(int decade, const StressView& view, const Progress& progress)
{
    const std::vector<Material> materials{lambert_material(Color(0.8f, 0.6f, 0.3f)), glass_material(1.5)};
    StressScene near = decades(decade, materials), middle = decades(0, materials);
    for (StressScene* scene : {&near, &middle}) {
        add_constant(*scene, Color(0.3f, 0.35f, 0.4f));
        LightDescription sun;
        sun.kind = LightDescription::Kind::distant;
        sun.direction = V3d(0.3, 0.4, -1);
        sun.irradiance = Color(1.5f);
        sun.angle = 40;
        scene->description.lights.push_back(sun);
    }
    StressView other = view;
    other.seed = 2;
    const StressPicture a = StressStage(near, {}, view, progress).render(view, progress),
                        b = StressStage(middle, {}, other, progress).render(other, progress);
    StressFinding finding = compare_means(a.film, b.film, 4);
    finding.count(a.statistics);
    finding.count(b.statistics);
    return finding;
}

StressScene lossless(int decade, const Material& material, const std::string& mesh = "")
{
    StressScene scene = decades(decade, {material});
    if (!mesh.empty()) {
        scene.meshes[mesh] = cube_mesh(1);
        scene.description.types[0].mesh = mesh;
    }
    return scene;
}

/// Compares the light between grains of black dust of radius 1e-6 on a ball of radius 1, which is invisible because its
/// index is 1. The view is so near that it shows few grains of dust, and not a whole number of them.
StressFinding dust(const V3d& offset, const StressView& view, const Progress& progress)
{
    constexpr double radius = 1e-6, step = 4 * radius;
    StressScene scene = scene_from_above(16, 7.3 * radius, 2);
    scene.description.camera.origin += V3d(1.7, -0.9, 0) * radius;
    scene.description.camera.target = V3d(1.7, -0.9, 0) * radius;
    add_type(scene, "dust", lambert_material(Color(0)));
    add_type(scene, "nothing", glass_material(1));
    scene.grains.push_back({V3d(0), 1, 1, {1, 0, 0, 0}});
    for (int y = -8; y <= 8; ++y) {
        for (int x = -8; x <= 8; ++x)
            scene.grains.push_back({V3d(step * x, step * y, 1).normalized() * (1 + radius), radius, 0, {1, 0, 0, 0}});
    }
    add_constant(scene, Color(1));
    Placing placing;
    placing.offset = offset;
    const StressPicture picture = StressStage(scene, placing, view, progress).render(view, progress);
    const auto left = [&](const V3d& o, const V3d&) {
        return std::hypot(std::remainder(o.x, step), std::remainder(o.y, step)) < radius ? 0.0 : 1.0;
    };
    StressFinding finding = compare_truth(picture.film, pixel_means(scene, 64, left), 4, 0.002);
    finding.count(picture.statistics);
    return finding;
}

} // namespace

void add_size_cases(StressRun& run)
{
    run.begin("sizes",
              "52 grains of radius 1e-9 to 1e3 in one scene: a near view of one decade, compared with the same view of "
              "another in the mean",
              "noise");
    for (const int decade : {-8, -5, -2, 1}) {
        run.add(fmt::format("radius 1e{} like radius 1, ept", decade),
                decade == -8 ? StressExtent::quick : StressExtent::full,
                [&] { return like_decade_zero(decade, {.spp = 1024}, run.progress()); });
    }
    run.add("radius 1e-8 like radius 1, ppt", StressExtent::full, [&] {
        return like_decade_zero(-8, {.kind = IntegratorKind::ppt, .accuracy = Accuracy::draft, .spp = 1024},
                                run.progress());
    });
    run.begin("sizes, furnace", "the same 52 grains, lossless, in surroundings of radiance 1, compared with 1",
              "1e-5: the rounding of some 100 float products");
    for (const int decade : {-9, -3, 3}) {
        run.add(fmt::format("glass, near radius 1e{}, ept", decade), StressExtent::quick,
                [&] { return furnace(lossless(decade, glass_material(1.5)), {.spp = 64}, run.progress()); });
        run.add(fmt::format("white, near radius 1e{}, ept", decade), StressExtent::quick,
                [&] { return furnace(lossless(decade, lambert_material(Color(1))), {.spp = 64}, run.progress()); });
    }
    for (const int decade : {-9, 3}) {
        run.add(fmt::format("glass cubes, near radius 1e{}, ept", decade), StressExtent::quick, [&] {
            return furnace(lossless(decade, glass_material(1.5), "cube.obj"), {.spp = 64}, run.progress());
        });
    }
    for (const IntegratorKind kind : {IntegratorKind::ppt, IntegratorKind::vpt, IntegratorKind::stf}) {
        run.add("glass, all, " + name_of(kind), StressExtent::full, [&] {
            return furnace(lossless(most, glass_material(1.5)), {.kind = kind, .accuracy = Accuracy::draft, .spp = 16},
                           run.progress());
        });
    }
    run.begin("radius ratio 1e6",
              "the light between black grains of radius 1e-6 on a ball of radius 1, compared with the area that they "
              "leave free, pixel by pixel",
              "noise; 0.2 % because a sum replaces the integral over a pixel");
    for (const IntegratorKind kind : {IntegratorKind::ept, IntegratorKind::ppt, IntegratorKind::automatic}) {
        run.add(
            "dust on a ball, " + name_of(kind), kind == IntegratorKind::ept ? StressExtent::quick : StressExtent::full,
            [&] { return dust(V3d(0), {.kind = kind, .accuracy = Accuracy::standard, .spp = 512}, run.progress()); });
    }
    run.add("dust on a ball at 1e7, ept", StressExtent::full,
            [&] { return dust(V3d(1e7), {.spp = 512}, run.progress()); });
}

} // namespace scree
