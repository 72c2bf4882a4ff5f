#include "tests/builders/slabs.h"

#include "base/warp.h"
#include "render/media/grid_medium_build.h"

#include <tbb/parallel_for.h>

namespace scree {

std::unique_ptr<TestScene> slab(double depth, const V3d& sigma_t, const Color& albedo, double g,
                                std::optional<StfForm> shells)
{
    auto scene = std::make_unique<TestScene>();
    const double wide = 3e3 * depth;
    scene->add_medium(box_mesh({-wide, -wide, -depth}, {wide, wide, 0}), sigma_t, albedo, g);
    scene->add_constant_light(1);
    if (shells) scene->use_shells(*shells);
    scene->build();
    return scene;
}

GridSlab::GridSlab(double depth, double sigma_t, float albedo, double g, double unit, std::optional<StfForm> shells)
{
    openvdb::initialize();
    const int across = 64, down = 8; // voxels; wide ones
    const double wide = 300 * depth;
    const auto grid = openvdb::FloatGrid::create(0);
    grid->fill(openvdb::CoordBBox({-across, -across, -down}, {across, across, down}),
               static_cast<float>(sigma_t / unit));
    MediumGrids grids{grid, nullptr, nullptr, {}, "slab"};
    grids.to_scene[0][0] = grids.to_scene[1][1] = unit * wide / across;
    grids.to_scene[2][2] = unit * depth / down;
    // The slab is cut out of the middle of the grid, where interpolation does not reach the grid's faces.
    const TriangleMesh mesh =
        box_mesh(unit * V3d(-0.5 * wide, -0.5 * wide, -0.5 * depth), unit * V3d(0.5 * wide, 0.5 * wide, 0.5 * depth));
    MediumRegion region{"slab", {}, mesh.triangles, nullptr, nullptr, false};
    GridMediumOptions options;
    options.albedo = Color(albedo);
    options.g = g;
    region.medium = std::make_shared<GridMedium>(make_grid_medium(grids, options, {}, {}));
    for (const V3d& p : mesh.positions) region.positions.emplace_back(p);
    world.regions.push_back(std::move(region));
    world.lights = LightSet({Light{}}, 1);
    prepare_media(world, shells);
    tracer = std::make_unique<Tracer>(std::make_shared<EmbreeDevice>(), world);
}

ReflectedAndPassed shine(const World& world, const Tracer& tracer, double distance, uint32_t paths, double cosine,
                         uint64_t seed)
{
    struct Value {
        Color radiance;
        bool up;
    };
    std::vector<Value> values(paths);
    tbb::parallel_for(uint32_t{0}, paths, [&](uint32_t p) {
        flush_subnormals();
        Sampler sampler(seed, p, 0, 0);
        const double u1 = sampler.next(), u2 = sampler.next();
        V3d d = cosine < 0 ? -sample_cosine_hemisphere(u1, u2) : V3d(std::sqrt(1 - cosine * cosine), 0, -cosine);
        const PathResult result = trace_path(world, tracer, -distance * d, d, sampler);
        values[p] = {result.radiance, result.last_direction.z > 0};
    });
    ReflectedAndPassed sum;
    for (const Value& value : values) {
        for (int c = 0; c < 3; ++c) {
            sum.up[c].add(value.up ? value.radiance[c] : 0);
            sum.down[c].add(value.up ? 0 : value.radiance[c]);
        }
    }
    return sum;
}

ReflectedAndPassed shine(const TestScene& scene, uint32_t paths, double cosine, uint64_t seed)
{
    return shine(scene.world(), scene.tracer(), 1, paths, cosine, seed);
}

Estimate from_all_around(const World& world, const Tracer& tracer, uint32_t count, double distance,
                         const PathOptions& options, uint64_t seed)
{
    std::vector<double> values(count);
    tbb::parallel_for(uint32_t{0}, count, [&](uint32_t p) {
        flush_subnormals();
        Sampler sampler(seed, p, 0, 0);
        const double u1 = sampler.next(), u2 = sampler.next();
        const V3d o = distance * sample_sphere(u1, u2);
        const V3d target(sampler.next() - 0.5, sampler.next() - 0.5, sampler.next() - 0.5);
        values[p] = trace_path(world, tracer, o, (target - o).normalized(), sampler, options).radiance.x;
    });
    Estimate radiance;
    for (const double value : values) radiance.add(value);
    return radiance;
}

} // namespace scree
