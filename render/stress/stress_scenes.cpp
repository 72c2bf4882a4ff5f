#include "render/stress/stress_scenes.h"

#include "base/sampler.h"
#include "packing/tiles/tile_generator.h"
#include "render/scene/camera.h"

#include <map>

namespace scree {

namespace {

Imath::Quatd any_rotation(uint32_t number)
{
    Sampler sampler(8, number, 0, 0);
    Imath::Quatd q;
    do {
        q.r = 2 * sampler.next() - 1;
        q.v = V3d(2 * sampler.next() - 1, 2 * sampler.next() - 1, 2 * sampler.next() - 1);
    } while (q.length() > 1 || q.length() < 0.1);
    return q.normalized();
}

LightDescription light_of(LightDescription::Kind kind)
{
    LightDescription light;
    light.kind = kind;
    return light;
}

} // namespace

StressScene empty_scene(int width, int height, const V3d& origin, const V3d& target, double fov)
{
    StressScene scene;
    scene.description.camera.origin = origin;
    scene.description.camera.target = target;
    scene.description.camera.fov = fov;
    scene.description.film.width = width;
    scene.description.film.height = height;
    return scene;
}

StressScene scene_from_above(int pixels, double width, double height)
{
    StressScene scene = empty_scene(pixels, pixels, V3d(0, 0, height), V3d(0), 35);
    scene.description.camera.kind = CameraKind::orthographic;
    scene.description.camera.width = width;
    scene.description.camera.up = V3d(0, 1, 0);
    return scene;
}

std::vector<double> pixel_means(const StressScene& scene, int parts,
                                const std::function<double(const V3d&, const V3d&)>& radiance)
{
    const int w = scene.description.film.width, h = scene.description.film.height;
    const Camera camera(scene.description.camera, w, h);
    std::vector<double> means;
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            double sum = 0;
            for (int j = 0; j < parts; ++j) {
                for (int i = 0; i < parts; ++i) {
                    const CameraRay ray = camera.ray(V2d(x + (i + 0.5) / parts, y + (j + 0.5) / parts), V2d(0));
                    sum += radiance(ray.o, ray.d);
                }
            }
            means.push_back(sum / (parts * parts));
        }
    }
    return means;
}

void add_constant(StressScene& scene, const Color& radiance)
{
    LightDescription light = light_of(LightDescription::Kind::constant);
    light.radiance = radiance;
    scene.description.lights.push_back(light);
}

void add_day(StressScene& scene)
{
    add_constant(scene, Color(0.3f, 0.35f, 0.4f));
    LightDescription sun = light_of(LightDescription::Kind::distant),
                     window = light_of(LightDescription::Kind::rectangle);
    sun.direction = V3d(0.3, 0.4, -1);
    sun.irradiance = Color(1.5f);
    sun.angle = 40;
    window.corner = V3d(-14, -16, 12);
    window.edge1 = V3d(14, 0, 0);
    window.edge2 = V3d(0, 10, 3);
    window.radiance = Color(3, 2.5f, 2);
    scene.description.lights.insert(scene.description.lights.end(), {sun, window});
}

void add_type(StressScene& scene, const std::string& name, const Material& material, const std::string& mesh)
{
    GrainTypeDescription type;
    type.name = name;
    type.material = material;
    if (!mesh.empty()) type.mesh = mesh;
    scene.description.types.push_back(type);
}

void add_medium(StressScene& scene, const std::string& mesh, double sigma_t, const Weight& albedo, double g)
{
    MediumDescription medium;
    medium.mesh = mesh;
    medium.sigma_t = Color(static_cast<Real>(sigma_t));
    medium.albedo = albedo;
    medium.g = g;
    scene.description.media.push_back(medium);
}

StressScene mixed_scene(const Progress& progress)
{
    StressScene scene = empty_scene(24, 18, V3d(-11, -13, 8), V3d(0, 0, -0.5), 40);
    scene.description.camera.aperture = 0.25;
    add_day(scene);
    scene.meshes["cube.obj"] = cube_mesh(1);
    scene.meshes["ball.obj"] = ball_mesh(1, 1);
    scene.meshes["floor.obj"] = {{V3d(-16, -16, -5), V3d(16, -16, -5), V3d(16, 16, -5), V3d(-16, 16, -5)},
                                 {{0, 1, 2}, {0, 2, 3}}};
    add_type(scene, "clay", lambert_material(Color(0.8f, 0.5f, 0.3f)));
    add_type(scene, "cube", lambert_material(Color(0.7f)), "cube.obj");
    add_type(scene, "gem", glass_material(1.4, 0.5, Color(0.125f, 0.25f, 0.5f)), "ball.obj");
    add_type(scene, "glass", glass_material(1.5, 0, Color(0.25f, 0.5f, 0.125f)));
    scene.description.surfaces.push_back({"floor.obj", lambert_material(Color(0.6f, 0.5f, 0.4f)), ""});
    const std::vector<V3d> places = packed_spheres(0.5, 48, 1, progress);
    for (size_t i = 0; i < places.size(); ++i)
        scene.grains.push_back({places[i], 1.03125, i % 4, any_rotation(static_cast<uint32_t>(i))});
    return scene;
}

StressScene bed_scene(const std::vector<Material>& materials, const Progress& progress)
{
    StressScene scene = empty_scene(24, 18, V3d(-38, -42, 30), V3d(0, 0, -1), 35);
    for (size_t i = 0; i < materials.size(); ++i) add_type(scene, "grain" + std::to_string(i), materials[i]);
    const std::vector<V3d> places = packed_spheres(0.55, 300, 2, progress);
    for (size_t i = 0; i < places.size(); ++i)
        scene.grains.push_back({places[i], 1, i % materials.size(), {1, 0, 0, 0}});
    return scene;
}

StressScene filled_scene(const Material& material, double radius, const Progress& progress)
{
    StressScene scene = empty_scene(24, 18, V3d(-3, -3.5, 2.5), V3d(0), 35);
    TileOptions options;
    options.fraction = 0.5;
    options.variants = 1;
    options.sweeps = 0;
    scene.tile = std::make_shared<PackingTile>(make_tile(std::vector<double>(200, 1.0), options, progress).tile);
    scene.filled = "cube.obj";
    scene.fill_radius = radius;
    scene.meshes["cube.obj"] = cube_mesh(1);
    add_type(scene, "grain", material);
    return scene;
}

StressScene ball_of_medium(double sigma_t, const Weight& albedo, double g)
{
    StressScene scene = empty_scene(24, 18, V3d(-3, -3.5, 2.5), V3d(0), 35);
    TriangleMesh ball = ball_mesh(1, 2);
    for (V3d& p : ball.positions) {
        for (int a = 0; a < 3; ++a) p[a] = std::round(p[a] * 0x1p20) * 0x1p-20;
    }
    scene.meshes["ball.obj"] = ball;
    add_medium(scene, "ball.obj", sigma_t, albedo, g);
    add_day(scene);
    return scene;
}

TriangleMesh cube_mesh(double half) { return box_mesh(V3d(-half), V3d(half)); }

TriangleMesh ball_mesh(double radius, int level)
{
    const double t = (1 + std::sqrt(5.0)) / 2;
    TriangleMesh mesh{{{-1, t, 0},
                       {1, t, 0},
                       {-1, -t, 0},
                       {1, -t, 0},
                       {0, -1, t},
                       {0, 1, t},
                       {0, -1, -t},
                       {0, 1, -t},
                       {t, 0, -1},
                       {t, 0, 1},
                       {-t, 0, -1},
                       {-t, 0, 1}},
                      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
    for (int i = 0; i < level; ++i) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [found, is_new] =
                middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(mesh.positions.size()));
            if (is_new) mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
            return found->second;
        };
        std::vector<std::array<uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
    }
    for (V3d& p : mesh.positions) p = p.normalized() * radius;
    return mesh;
}

} // namespace scree
