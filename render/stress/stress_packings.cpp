// Packings with no grain, with one, and as dense as possible; and paths of a million vertices through grains, media and
// a white room.

#include "render/stress/stress_furnace.h"
#include "render/stress/stress_scenes.h"

#include <fmt/format.h>

namespace scree {

namespace {

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

/// Spheres that dumps should not contain but do: duplicates, one inside another, touching from inside.
StressScene odd_grains(const Material& material)
{
    StressScene scene = few_grains(material, 0);
    const auto add = [&](const V3d& center, double radius) {
        scene.grains.push_back({center, radius, 0, {1, 0, 0, 0}});
    };
    for (int i = 0; i < 3; ++i) add(V3d(0), 1);
    add(V3d(0.25, 0, 0), 0.25);
    add(V3d(0, 0.5, 0), 0.5);
    add(V3d(0, -1.5, 0), 0.5);
    add(V3d(0, 0, 1), 0);
    for (int i = 0; i < 200; ++i) add(V3d(1.5, 0, 0.5), 0.25);
    return scene;
}

/// Length of a ray inside a sphere.
double chord(const StressGrain& grain, const V3d& o, const V3d& d)
{
    const V3d to = grain.center - o;
    return 2 * safe_sqrt(grain.radius * grain.radius - (to - to.dot(d) * d).length2());
}

/// The same for a cube whose corners are on the sphere.
double cube_chord(const StressGrain& grain, const V3d& o, const V3d& d)
{
    Placing back;
    back.rotation = grain.orientation.inverse();
    const V3d from = back.direction(o - grain.center), along = back.direction(d);
    const double half = grain.radius / std::sqrt(3.0);
    double enter = -1e300, leave = 1e300;
    for (int a = 0; a < 3; ++a) {
        const double t0 = (-half - from[a]) / along[a], t1 = (half - from[a]) / along[a];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
    }
    return std::max(0.0, leave - enter);
}

/// Compares the light along straight lines through 108 grains that absorb and do not refract, on a close-packed
/// lattice, seen at an angle in surroundings of 1.
StressFinding straight_through(const Material& material, bool cubes, const StressView& view, const Progress& progress)
{
    StressScene scene = empty_scene(16, 16, V3d(-7.3, -9.1, 12.7), V3d(0.1, 0.2, -0.3), 35);
    scene.description.camera.kind = CameraKind::orthographic;
    scene.description.camera.width = 9;
    add_type(scene, "grain", material, cubes ? "cube.obj" : "");
    if (cubes) scene.meshes["cube.obj"] = cube_mesh(1);
    for (const V3d& place : fcc_spheres(3)) {
        const auto number = static_cast<double>(scene.grains.size());
        const Imath::Quatd turn(1 + std::sin(number),
                                V3d(std::sin(2 * number), std::cos(3 * number), std::sin(5 * number)));
        scene.grains.push_back({place, 1, 0, turn.normalized()});
    }
    add_constant(scene, Color(1));
    const StressPicture picture = StressStage(scene, {}, view, progress).render(view, progress);
    const bool opaque = material.kind == MaterialKind::lambert;
    const auto left = [&](const V3d& o, const V3d& d) {
        double length = 0;
        for (const StressGrain& grain : scene.grains) length += cubes ? cube_chord(grain, o, d) : chord(grain, o, d);
        return opaque ? (length > 0 ? 0.0 : 1.0) : std::exp(-double{material.absorption.x} * length);
    };
    StressFinding finding = compare_truth(picture.film, pixel_means(scene, 32, left), 4, 0.002);
    finding.count(picture.statistics);
    return finding;
}

StressScene from_within(StressScene scene, int width, int height)
{
    scene.description.camera.origin = V3d(0.001, 0.002, 0.003);
    scene.description.camera.target = V3d(1, 0.3, 0.2);
    scene.description.film.width = width;
    scene.description.film.height = height;
    return scene;
}

/// A white ball seen from inside, with a hole of 1 / mean of its surface.
///
/// Diffuse reflection in a ball reaches its whole surface uniformly, so every segment but the first leaves through the
/// hole with a probability of 1 / mean. Paths have 1 + mean segments on average, with a standard deviation of about the
/// mean.
StressFinding room(double mean, int pixels, uint32_t spp, const Progress& progress)
{
    TriangleMesh ball = ball_mesh(1, 2);
    const auto area_of = [&](const std::array<uint32_t, 3>& t) {
        const V3d a = ball.positions[t[0]];
        return 0.5 * (ball.positions[t[1]] - a).cross(ball.positions[t[2]] - a).length();
    };
    double area = 0;
    for (const std::array<uint32_t, 3>& triangle : ball.triangles) area += area_of(triangle);
    const std::array<uint32_t, 3> last = ball.triangles.back(); // the hole is at its corner a
    const double part = std::sqrt(area / (mean * area_of(last)));
    ball.triangles.pop_back();
    const V3d a = ball.positions[last[0]], b = ball.positions[last[1]], c = ball.positions[last[2]];
    const auto n = static_cast<uint32_t>(ball.positions.size());
    ball.positions.push_back(a + part * (b - a));
    ball.positions.push_back(a + part * (c - a));
    ball.triangles.push_back({n, last[1], last[2]});
    ball.triangles.push_back({n, last[2], n + 1});
    StressScene scene = from_within(empty_scene(1, 1, V3d(0), V3d(1, 0, 0), 35), pixels, pixels);
    scene.description.camera.target = V3d(-1, -0.4, 0); // away from the hole
    scene.meshes["room.obj"] = ball;
    scene.description.surfaces.push_back({"room.obj", lambert_material(Color(1)), ""});
    StressFinding finding = furnace(scene, {.spp = spp}, progress);
    if (!finding.passed()) return finding;
    const double root = std::sqrt(static_cast<double>(finding.paths));
    finding.unit = "sigma";
    finding.deviation = std::abs(finding.length() - 1 - mean) / mean * root;
    finding.allowed = critical_z(stress_level, 1);
    finding.sees = (finding.allowed + 1.2816) / root;
    return finding;
}

} // namespace

void add_packing_cases(StressRun& run)
{
    run.begin("packings", "lossless spheres in surroundings of radiance 1, compared with 1",
              "1e-5: the rounding of some 100 float products");
    for (const IntegratorKind kind : all_kinds) {
        const StressView view{.kind = kind, .accuracy = Accuracy::draft, .spp = 32};
        const StressExtent extent = kind == IntegratorKind::ept ? StressExtent::quick : StressExtent::full;
        run.add("no grain, " + name_of(kind), StressExtent::quick,
                [&] { return furnace(few_grains(glass_material(1.5), 0), view, run.progress()); });
        run.add("one grain, " + name_of(kind), extent,
                [&] { return furnace(few_grains(glass_material(1.5), 1), view, run.progress()); });
        run.add("2,916 touching spheres of glass, f 0.74, " + name_of(kind), extent,
                [&] { return furnace(fcc(glass_material(1.5), 9), view, run.progress()); });
        run.add("grains in each other, glass, " + name_of(kind), extent,
                [&] { return furnace(odd_grains(glass_material(1.5)), view, run.progress()); });
        run.add("grains in each other, white, " + name_of(kind), extent,
                [&] { return furnace(odd_grains(lambert_material(Color(1))), view, run.progress()); });
        run.add("2,916 touching white spheres, f 0.74, " + name_of(kind), extent,
                [&] { return furnace(fcc(lambert_material(Color(1)), 9), view, run.progress()); });
    }

    run.begin("packings, straight",
              "the light that passes 108 touching spheres, or cubes inside them, along straight lines, compared with "
              "sums of chords, pixel by pixel",
              "noise; 0.2 % because a sum replaces the integral over a pixel");
    for (const IntegratorKind kind : {IntegratorKind::ept, IntegratorKind::automatic}) {
        const StressView view{.kind = kind, .accuracy = Accuracy::standard, .spp = 1024};
        for (const bool cubes : {false, true}) {
            const StressExtent extent = kind == IntegratorKind::ept ? StressExtent::quick : StressExtent::full;
            const std::string what = cubes ? "cubes, " : "spheres, ";
            run.add("black " + what + name_of(kind), extent,
                    [&] { return straight_through(lambert_material(Color(0)), cubes, view, run.progress()); });
            run.add("absorbing " + what + name_of(kind), extent,
                    [&] { return straight_through(glass_material(1, 0, Color(0.25f)), cubes, view, run.progress()); });
        }
    }
}

void add_long_path_cases(StressRun& run)
{
    run.begin("long paths", "lossless objects seen from deep inside, in surroundings of radiance 1, compared with 1",
              "1e-5: a weight that no event changes is not rounded");
    for (const IntegratorKind kind : {IntegratorKind::vpt, IntegratorKind::stf}) {
        run.add("the middle of a cube of optical radius 1000, " + name_of(kind), StressExtent::full, [&] {
            StressScene scene = from_within(empty_scene(1, 1, V3d(0), V3d(1, 0, 0), 35), 4, 4);
            scene.meshes["cube.obj"] = cube_mesh(1);
            add_medium(scene, "cube.obj", 1000, Color(1), 0);
            StressFinding finding =
                furnace(scene, {.kind = kind, .accuracy = Accuracy::draft, .spp = 2}, run.progress());
            finding.least_length =
                kind == IntegratorKind::vpt ? 3e5 : 0; // 0.6745 r^2 scatterings; shells skip many in one step
            return finding;
        });
    }
    struct Deep {
        const char* grains;
        const char* number;
        Material material;
        double radius;
    };
    // Light crosses several glass spheres before it loses its direction, so that equally long paths need more of them.
    for (const auto& [grains, number, material, radius] :
         {Deep{"spheres of glass", "10^11", glass_material(1.5), 0.0002},
          Deep{"spheres of rough glass", "10^10", glass_material(1.5, 0.5), 0.0005},
          Deep{"white spheres", "10^9", lambert_material(Color(1)), 0.001}}) {
        for (const IntegratorKind kind : {IntegratorKind::ept, IntegratorKind::ppt}) {
            run.add(fmt::format("the middle of {} {}, {}", number, grains, name_of(kind)), StressExtent::full, [&] {
                const StressScene scene = from_within(filled_scene(material, radius, run.progress()), 4, 2);
                StressFinding finding =
                    furnace(scene, {.kind = kind, .accuracy = Accuracy::draft, .spp = 1}, run.progress());
                finding.least_length =
                    kind == IntegratorKind::ept ? 2e5 : 1e5; // a proxy makes one vertex for each grain
                return finding;
            });
        }
    }
    run.begin("long paths, lengths",
              "the mean length of paths in a white ball with a hole, compared with 1 + surface / hole; and the furnace",
              "noise");
    for (const auto& [mean, pixels, spp, must_see] :
         {std::tuple(1e3, 16, 32u, 0.07), std::tuple(1e4, 8, 32u, 0.15), std::tuple(1e6, 4, 1u, 1.5)}) {
        run.add(fmt::format("a hole of {:g} of the surface, ept", 1 / mean),
                mean < 1e4 ? StressExtent::quick : StressExtent::full, [&] {
                    StressFinding finding = room(mean, pixels, spp, run.progress());
                    finding.must_see = must_see;
                    return finding;
                });
    }
}

} // namespace scree
