#include "render/app/grain_portrait.h"

#include "base/error.h"
#include "render/build/light_builder.h"
#include "render/loop/render_loop.h"

namespace scree {

namespace {

const V3d to_viewer(0.6, -6.5, 5.2), to_sun(-0.9, -0.45, 0.75);

/// Turns the mesh to lie on the side on which its middle is lowest; tilts a flat mesh so that it mirrors the sun to the
/// viewer.
void lay_down(TriangleMesh& mesh)
{
    constexpr int directions = 400;
    V3d down(0, 0, -1);
    double lowest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < directions; ++i) { // evenly over the sphere (Fibonacci)
        const double z = 1 - (2 * i + 1.0) / directions, phi = 2 * pi * std::numbers::phi * i, r = std::sqrt(1 - z * z);
        const V3d d(r * std::cos(phi), r * std::sin(phi), z);
        double reach = 0;
        for (size_t k = 0; k < mesh.positions.size(); k += 1 + mesh.positions.size() / 20000)
            reach = std::max(reach, mesh.positions[k].dot(d));
        if (reach < lowest) {
            lowest = reach;
            down = d;
        }
    }
    const Frame frame(-down);
    const bool flat = lowest < 0.2;
    const Frame stand(flat ? (to_viewer.normalized() + to_sun.normalized()).normalized() : V3d(0, 0, 1));
    for (V3d& p : mesh.positions) p = stand.to_world(frame.to_local(p));
}

/// A sky that is brighter towards the horizon, so that clear grains show their shape.
std::shared_ptr<const EnvironmentMap> make_sky()
{
    constexpr size_t width = 64, height = 32;
    std::vector<Color> texels;
    for (size_t y = 0; y < height; ++y) {
        const double up = std::cos(pi * (static_cast<double>(y) + 0.5) / height);
        for (size_t x = 0; x < width; ++x) {
            const auto haze = static_cast<float>(std::exp(-3 * std::abs(up)));
            texels.push_back(Color(0.28f, 0.34f, 0.42f) * (1 - haze) + Color(0.85f, 0.85f, 0.85f) * haze);
        }
    }
    return std::make_shared<EnvironmentMap>(std::move(texels), width, height, V3d(0, 0, 1), Color(1.0f));
}

World make_world(const LibraryGrain& grain, const ShapeOptions& shape, const std::string& place,
                 const EmbreeDevice& device)
{
    World world; // one unit of length is the grain's radius
    GrainType type{grain.name, grain.material, nullptr};
    type.material.absorption *= static_cast<float>(grain.typical_radius);
    double lowest = -1;
    if (grain.default_triangles > 0 || shape.triangles > 0) {
        TriangleMesh mesh = make_grain_shape(grain, shape, place);
        lay_down(mesh);
        lowest = std::ranges::min_element(mesh.positions, {}, &V3d::z)->z;
        type.exemplar = std::make_shared<Exemplar>(device, mesh, place);
        world.grains.orientation.push_back(Imath::Quatf(1, 0, 0, 0));
    }
    world.grains.spheres = {{0, 0, 0, 1}, {}};
    world.grains.type_codes = {0};
    world.grains.analytic_count = type.exemplar ? 0 : 1;
    world.grains.widen();
    world.types.push_back(std::move(type));

    constexpr float half = 60; // half the floor's width: as good as infinite to the camera and the grain
    const auto z = static_cast<float>(lowest - 0x1p-12);
    Surface floor{
        "floor", {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}}, {{0, 1, 2}, {0, 2, 3}}, {}};
    floor.material.reflectance = Color(0.12f);
    world.surfaces.push_back(std::move(floor));

    LightDescription sky, sun;
    sky.kind = LightDescription::Kind::environment;
    sun.kind = LightDescription::Kind::distant;
    sun.direction = -to_sun;
    sun.irradiance = Color(2.2f, 2.1f, 1.95f);
    sun.angle = 32; // degrees, as through haze, so that sunlight through the grain converges soon
    world.lights = LightSet({make_light(sky, make_sky(), world.space), make_light(sun, nullptr, world.space)}, 2);
    return world;
}

} // namespace

Film render_portrait(const LibraryGrain& grain, const ShapeOptions& shape, const PortraitOptions& options,
                     const std::string& place, const Progress& progress)
{
    const auto device = std::make_shared<EmbreeDevice>();
    const World world = make_world(grain, shape, place, *device);
    const Tracer tracer(device, world);
    CameraDescription view;
    view.origin = to_viewer;
    view.target = V3d(0.06, 0, 0);
    view.fov = 17.5;
    const Camera camera(view, options.size, options.size);
    Film film(options.size, options.size, 0, 0, options.size, options.size);
    RenderOptions rendering;
    rendering.spp = options.spp;
    const RenderStatistics done = render(world, tracer, camera, Filter(), film, rendering, progress);
    if (done.cancelled) throw Cancelled();
    return film;
}

} // namespace scree
