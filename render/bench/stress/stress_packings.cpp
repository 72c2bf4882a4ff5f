// Packings without a grain, with one, and as full as they get; and paths of a million vertices through grains, media and a white room.

#include "render/bench/stress/stress_run.h"
#include "render/bench/stress/stress_scenes.h"

#include <fmt/format.h>

namespace scree {

namespace {

constexpr IntegratorKind all_kinds[] = {IntegratorKind::ept, IntegratorKind::ppt, IntegratorKind::automatic, IntegratorKind::vpt, IntegratorKind::stf};

/// Every pixel with 1, in a surrounding of 1.
StressFinding white(StressScene scene, const StressView& view, double allowed, const Progress& progress)
{
    add_constant(scene, Color(1));
    const StressPicture picture = StressStage(scene, {}, view, progress).render(view, progress);
    StressFinding finding = compare_exactly(picture.film, 1, allowed);
    finding.count(picture.statistics);
    const double steps = static_cast<double>(picture.statistics.segments + picture.statistics.events);
    finding.remark = fmt::format("{:.3g} segments and events a path, {} leaks", steps / static_cast<double>(std::max<uint64_t>(1, finding.paths)), finding.leaks);
    return finding;
}

StressScene few_grains(const Material& material, uint64_t count)
{
    StressScene scene = empty_scene(16, 12, V3d(-3, -4, 2), V3d(0), 35);
    add_type(scene, "grain", material);
    scene.has_dump = true;
    if (count > 0) scene.grains.push_back({V3d(0), 1, 0, {1, 0, 0, 0}});
    return scene;
}

StressScene fcc(const Material& material, int cells)
{
    StressScene scene = empty_scene(16, 12, V3d(-3, -4, 2) * (cells * 1.6), V3d(0), 35);
    add_type(scene, "grain", material);
    for (const V3d& place : fcc_spheres(cells)) scene.grains.push_back({place, 1, 0, {1, 0, 0, 0}});
    return scene;
}

/// Spheres that dumps should not hold and do: twice the same, one within another, touching from within.
StressScene odd_grains(const Material& material)
{
    StressScene scene = few_grains(material, 0);
    const auto add = [&](const V3d& center, double radius) { scene.grains.push_back({center, radius, 0, {1, 0, 0, 0}}); };
    for (int i = 0; i < 3; ++i) add(V3d(0), 1);
    add(V3d(0.25, 0, 0), 0.25);
    add(V3d(0, 0.5, 0), 0.5);
    add(V3d(0, -1.5, 0), 0.5);
    add(V3d(0, 0, 1), 0);
    for (int i = 0; i < 200; ++i) add(V3d(1.5, 0, 0.5), 0.25);
    return scene;
}

} // namespace

void add_packing_cases(StressRun& run)
{
    run.begin("packings", "lossless spheres in a surrounding of 1 with 1", "1e-5: the rounding of some 100 products of floats");
    for (const IntegratorKind kind : all_kinds) {
        const StressView view{.kind = kind, .accuracy = Accuracy::draft, .spp = 32};
        const StressExtent extent = kind == IntegratorKind::ept ? StressExtent::quick : StressExtent::full;
        run.add("no grain, " + name_of(kind), StressExtent::quick, [&] { return white(few_grains(glass_material(1.5), 0), view, 1e-5, run.progress()); });
        run.add("one grain, " + name_of(kind), extent, [&] { return white(few_grains(glass_material(1.5), 1), view, 1e-5, run.progress()); });
        run.add("2,916 touching spheres of glass, f 0.74, " + name_of(kind), extent, [&] { return white(fcc(glass_material(1.5), 9), view, 1e-5, run.progress()); });
        run.add("grains in each other, glass, " + name_of(kind), extent, [&] { return white(odd_grains(glass_material(1.5)), view, 1e-5, run.progress()); });
        run.add("grains in each other, white, " + name_of(kind), extent, [&] { return white(odd_grains(lambert_material(Color(1))), view, 1e-5, run.progress()); });
        run.add("2,916 touching white spheres, f 0.74, " + name_of(kind), extent, [&] { return white(fcc(lambert_material(Color(1)), 9), view, 1e-5, run.progress()); });
    }
}

void add_long_path_cases(StressRun& run)
{
    run.begin("long paths", "lossless things seen from deep within, in a surrounding of 1, with 1", "1e-5: a weight that no event changes is not rounded");
    const auto from_within = [](StressScene scene, int width, int height) {
        scene.description.camera.origin = V3d(0.001, 0.002, 0.003);
        scene.description.camera.target = V3d(1, 0.3, 0.2);
        scene.description.film.width = width;
        scene.description.film.height = height;
        return scene;
    };
    for (const IntegratorKind kind : {IntegratorKind::vpt, IntegratorKind::stf}) {
        run.add("the middle of a cube of optical radius 1000, " + name_of(kind), StressExtent::full, [&] {
            StressScene scene = from_within(empty_scene(1, 1, V3d(0), V3d(1, 0, 0), 35), 4, 4);
            scene.meshes["cube.obj"] = cube_mesh(1);
            add_medium(scene, "cube.obj", 1000, Color(1), 0);
            return white(scene, {.kind = kind, .accuracy = Accuracy::draft, .spp = 2}, 1e-5, run.progress());
        });
    }
    struct Deep {
        const char* grains;
        const char* number;
        Material material;
        double radius;
    };
    // Light passes several spheres of glass before it is turned, so that there must be more of them for as long a way.
    for (const auto& [grains, number, material, radius] : {Deep{"spheres of glass", "10^11", glass_material(1.5), 0.0002}, Deep{"spheres of rough glass", "10^10", glass_material(1.5, 0.5), 0.0005},
                                                           Deep{"white spheres", "10^9", lambert_material(Color(1)), 0.001}}) {
        for (const IntegratorKind kind : {IntegratorKind::ept, IntegratorKind::ppt}) {
            run.add(fmt::format("the middle of {} {}, {}", number, grains, name_of(kind)), StressExtent::full, [&] {
                const StressScene scene = from_within(filled_scene(material, radius, run.progress()), 2, 2);
                return white(scene, {.kind = kind, .accuracy = Accuracy::draft, .spp = 1}, 1e-5, run.progress());
            });
        }
    }
    run.add("a white room with a pin hole, ept", StressExtent::quick, [&] {
        StressScene scene = from_within(empty_scene(1, 1, V3d(0), V3d(1, 0, 0), 35), 2, 2);
        TriangleMesh room = cube_mesh(1); // of one of its triangles the hole takes a corner, 1e-6 of the walls
        const std::array<uint32_t, 3> last = room.triangles.back();
        room.triangles.pop_back();
        const V3d a = room.positions[last[0]], b = room.positions[last[1]], c = room.positions[last[2]];
        const auto n = static_cast<uint32_t>(room.positions.size());
        constexpr double part = 0.0035; // of the edges at the corner a: a hole of part^2 of 2, of walls of 24
        room.positions.push_back(a + part * (b - a));
        room.positions.push_back(a + part * (c - a));
        room.triangles.push_back({n, last[1], last[2]});
        room.triangles.push_back({n, last[2], n + 1});
        scene.meshes["room.obj"] = room;
        scene.description.surfaces.push_back({"room.obj", lambert_material(Color(1)), ""});
        return white(scene, {.spp = 1}, 1e-5, run.progress());
    });
}

} // namespace scree
