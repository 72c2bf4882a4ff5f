// The cost of walks through a heterogeneous medium: a cloud of 256^3 voxels, one thread.
// usage: medium_bench [--quick]

#include "base/noise.h"
#include "render/integrators/path_tracer.h"
#include "render/media/grid_medium_build.h"
#include "render/media/phase_function.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cstring>
#include <ctime>

namespace scree {
namespace {

/// Processor seconds of this program: other programs on a busy machine do not count.
double busy_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

constexpr int size = 256;

/// Octaves of noise under a falloff towards the sides of the cube -1..1: about a third of the voxels hold density, in
/// 0..1.
openvdb::FloatGrid::Ptr make_cloud()
{
    NoiseOptions options;
    options.scale = V3d(0.5);
    options.octaves = 6;
    options.seed = 7;
    const FractalNoise noise(options);
    std::vector<float> values(size_t{size} * size * size);
    tbb::parallel_for(0, size, [&](int x) {
        for (int y = 0; y < size; ++y)
            for (int z = 0; z < size; ++z) {
                const V3d p(2 * (x + 0.5) / size - 1, 2 * (y + 0.5) / size - 1, 2 * (z + 0.5) / size - 1);
                const double density = 0.55 + 1.6 * noise(p) - p.dot(p);
                values[(static_cast<size_t>(x) * size + static_cast<size_t>(y)) * size + static_cast<size_t>(z)] =
                    static_cast<float>(std::min(std::max(density, 0.0), 1.0));
            }
    });
    auto grid = openvdb::FloatGrid::create(0);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(2.0 / size));
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    auto accessor = grid->getAccessor();
    for (int x = 0; x < size; ++x)
        for (int y = 0; y < size; ++y)
            for (int z = 0; z < size; ++z)
                if (const float v = values[(static_cast<size_t>(x) * size + static_cast<size_t>(y)) * size +
                                           static_cast<size_t>(z)];
                    v > 0)
                    accessor.setValue(openvdb::Coord(x - size / 2, y - size / 2, z - size / 2), v);
    return grid;
}

struct Ray {
    V3d o, d;
};

/// From a sphere around the cloud towards its inside.
Ray draw_ray(Sampler& sampler)
{
    const auto on_sphere = [&] {
        const double z = 2 * sampler.next() - 1, phi = 2 * pi * sampler.next(), s = safe_sqrt(1 - z * z);
        return V3d(s * std::cos(phi), s * std::sin(phi), z);
    };
    const V3d o = 2.0 * on_sphere(), target = 0.8 * std::cbrt(sampler.next()) * on_sphere();
    return {o, (target - o).normalized()};
}

V3d scatter(const V3d& d, double g, Sampler& sampler)
{
    const double cosine = sample_henyey_greenstein(g, sampler.next()), phi = 2 * pi * sampler.next(),
                 sine = safe_sqrt(1 - cosine * cosine);
    return Frame(d).to_world({sine * std::cos(phi), sine * std::sin(phi), cosine}).normalized();
}

struct Rate {
    double events = 0; ///< a second
    double per_path = 0;
};

/// Lossless walks until they leave the medium.
Rate walk(const GridMedium& medium, double g, uint32_t paths)
{
    const double start = busy_seconds();
    uint64_t events = 0;
    for (uint32_t i = 0; i < paths; ++i) {
        Sampler sampler(1, i, 0, 0);
        Ray ray = draw_ray(sampler);
        SpectralState state;
        for (;;) {
            const MediumEvent event =
                medium.event(ray.o, ray.d, 0, std::numeric_limits<double>::infinity(), state, sampler);
            if (!event.scattered) break;
            ++events;
            ray.o += ray.d * event.t;
            ray.d = scatter(ray.d, g, sampler);
        }
    }
    const double seconds = (busy_seconds() - start);
    return {static_cast<double>(events) / seconds, static_cast<double>(events) / paths};
}

double transmittances(const GridMedium& medium, uint32_t rays, double& mean)
{
    const double start = busy_seconds();
    double sum = 0;
    for (uint32_t i = 0; i < rays; ++i) {
        Sampler sampler(2, i, 0, 0);
        const Ray ray = draw_ray(sampler);
        sum += double{medium.transmittance(ray.o, ray.d, 0, std::numeric_limits<double>::infinity(), sampler).x};
    }
    mean = sum / rays;
    return rays / (busy_seconds() - start);
}

/// Paths of the renderer from all around towards the middle; their events a second.
Rate trace(const World& world, const Tracer& tracer, double distance, uint32_t paths)
{
    const double start = busy_seconds();
    uint64_t events = 0;
    for (uint32_t i = 0; i < paths; ++i) {
        Sampler sampler(3, i, 0, 0);
        Ray ray = draw_ray(sampler);
        events += trace_path(world, tracer, 0.5 * distance * ray.o, ray.d, sampler).events;
    }
    return {static_cast<double>(events) / (busy_seconds() - start), static_cast<double>(events) / paths};
}

/// A sphere of optical radius 50.
void run_sphere(bool quick)
{
    fmt::print("A sphere of optical radius 50 and 20,480 triangles, whole paths; one thread. Millions of events a "
               "second.\n\n{:>6} {:>8} {:>14} {:>10} {:>12} {:>10}\n",
               "g", "albedo", "constant light", "a path", "sun and sky", "a path");
    for (const auto& [g, albedo] : {std::pair{0.0, 1.0f}, {0.7, 1.0f}, {0.7, 0.99f}}) {
        TestScene constant, sunny;
        for (TestScene* scene : {&constant, &sunny}) {
            scene->add_medium(icosphere(5), V3d(50), Color(albedo), g);
            scene->add_constant_light(0.3f);
        }
        Light sun;
        sun.kind = LightKind::distant;
        sun.direction = V3d(0.5, 0.3, 0.8).normalized();
        sun.one_minus_cos = 1e-5;
        sun.radiance = Color(4e4f);
        sunny.add_light(sun);
        constant.build();
        sunny.build();
        const uint32_t paths = quick ? 2000 : 20000;
        const Rate plain = trace(constant.world(), constant.tracer(), 3, paths),
                   lit = trace(sunny.world(), sunny.tracer(), 3, paths);
        fmt::print("{:6} {:8} {:14.2f} {:10.1f} {:12.2f} {:10.1f}\n", g, albedo, plain.events / 1e6, plain.per_path,
                   lit.events / 1e6, lit.per_path);
    }
    fmt::print("\n");
}

void run(bool quick)
{
    run_sphere(quick);
    const openvdb::FloatGrid::Ptr cloud = make_cloud();
    fmt::print("A cloud of {}^3 voxels, {:.0f} % of them not empty, in a cube of side 2; one thread, best of {} runs.\n"
               "Lossless walks until they leave; transmittances from outside to outside. Millions a second.\n\n",
               size, 100 * static_cast<double>(cloud->activeVoxelCount()) / (double{size} * size * size),
               quick ? 1 : 3);
    fmt::print("{:>8} {:>9} {:>10} {:>14} {:>12} {:>14} {:>12} {:>8}\n", "sigma_t", "set-up s", "memory MB",
               "events, g=0", "a path", "events, g=.85", "a path", "T");
    for (const double sigma : {1.0, 10.0, 100.0, 1000.0}) {
        MediumGrids grids;
        grids.density = cloud;
        GridMediumOptions options;
        options.scale = Color(static_cast<Real>(sigma));
        const double start = busy_seconds();
        const GridMedium medium = make_grid_medium(grids, options, {}, {});
        const double setup = (busy_seconds() - start);
        Rate isotropic, forward;
        double shadows = 0, mean = 0;
        const uint32_t paths = static_cast<uint32_t>((quick ? 3e5 : 3e6) / (3 + sigma));
        for (int run = 0; run < (quick ? 1 : 3); ++run) {
            const Rate a = walk(medium, 0, paths), b = walk(medium, 0.85, paths);
            isotropic = {std::max(isotropic.events, a.events), a.per_path};
            forward = {std::max(forward.events, b.events), b.per_path};
            shadows = std::max(shadows, transmittances(medium, quick ? 50000 : 300000, mean));
        }
        fmt::print("{:8} {:9.2f} {:10.1f} {:14.2f} {:12.2f} {:14.2f} {:12.2f} {:8.2f}   mean T {:.4f}\n", sigma, setup,
                   static_cast<double>(medium.bytes()) / 1e6, isotropic.events / 1e6, isotropic.per_path,
                   forward.events / 1e6, forward.per_path, shadows / 1e6, mean);
    }
}

} // namespace
} // namespace scree

int main(int argc, char** argv)
{
    scree::run(argc > 1 && std::strcmp(argv[1], "--quick") == 0);
    return 0;
}
