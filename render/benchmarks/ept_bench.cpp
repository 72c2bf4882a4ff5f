// Explicit path tracing compared with Embree alone: segments of light paths a second, shading included, beside the bare
// nearest-hit query over the same segments, in one process and on one thread.
//
// usage: ept_bench [--quick]     (--quick: 10^5 grains and fewer paths)

#include "render/integrators/path_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <optional>

namespace scree {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr double fraction = 0.6;

struct Segment {
    V3f o, d;
};

/// The same grains for Embree alone: bare sphere points, or one instance of the mesh a grain.
class BareScene {
public:
    BareScene(const TestScene& scene, const TriangleMesh* mesh)
        : device_(scene.device().get()), scene_(rtcNewScene(device_))
    {
        const GrainStore& grains = scene.world().grains;
        if (!mesh) {
            RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
            rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, grains.spheres.data(), 0,
                                       sizeof(GrainStore::Sphere), grains.size());
            add(scene_, geometry);
        } else {
            mesh_scene_ = rtcNewScene(device_);
            RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
            auto* vertices = static_cast<V3f*>(rtcSetNewGeometryBuffer(
                geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f), mesh->positions.size()));
            for (size_t i = 0; i < mesh->positions.size(); ++i) vertices[i] = V3f(mesh->positions[i]);
            auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
                geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh->triangles.size()));
            std::memcpy(indices, mesh->triangles.data(), 12 * mesh->triangles.size());
            add(mesh_scene_, geometry);
            rtcCommitScene(mesh_scene_);
            for (uint32_t i = 0; i < grains.size(); ++i) add(scene_, instance(scene.world(), i));
        }
        rtcCommitScene(scene_);
    }
    ~BareScene()
    {
        rtcReleaseScene(scene_);
        if (mesh_scene_) rtcReleaseScene(mesh_scene_);
    }

    /// Seconds for the nearest hits of all segments.
    double walk(const std::vector<Segment>& segments, float skip) const
    {
        const auto start = Clock::now();
        uint64_t hits = 0;
        for (const Segment& s : segments) {
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            RTCRayHit ray{};
            ray.ray = {s.o.x, s.o.y, s.o.z, skip, s.d.x, s.d.y, s.d.z, 0, std::numeric_limits<float>::infinity(),
                       ~0u,   0,     0};
            ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene_, &context, &ray);
            hits += ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        }
        const double seconds = seconds_since(start);
        if (hits == 0) fmt::print("no hits: nothing was measured\n");
        return seconds;
    }

private:
    static void add(RTCScene scene, RTCGeometry geometry)
    {
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    RTCGeometry instance(const World& world, uint32_t i) const
    {
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, mesh_scene_);
        const Imath::M33d m = world.rotation(i);
        const auto r = static_cast<float>(world.grains.radius(i));
        const V3f c(world.grains.centre(i));
        float columns[12];
        for (int row = 0; row < 3; ++row) {
            for (int k = 0; k < 3; ++k) columns[3 * row + k] = r * static_cast<float>(m[row][k]);
        }
        columns[9] = c.x;
        columns[10] = c.y;
        columns[11] = c.z;
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        return geometry;
    }

    RTCDevice device_;
    RTCScene scene_, mesh_scene_ = nullptr;
};

/// Rays into the bed from all around.
std::pair<V3d, V3d> start_ray(Sampler& sampler)
{
    const double z = 2 * sampler.next() - 1, phi = 2 * pi * sampler.next(), r = std::sqrt(1 - z * z);
    const V3d o = 3.0 * V3d(r * std::cos(phi), r * std::sin(phi), z);
    const V3d target(sampler.next() - 0.5, sampler.next() - 0.5, sampler.next() - 0.5);
    return {o, (target - o).normalized()};
}

void run(const char* name, uint64_t count, const std::vector<PackedSphere>& spheres, const Material& material,
         const std::optional<TriangleMesh>& mesh, double seconds_wanted)
{
    TestScene scene;
    const auto before = scene.device().bytes();
    const uint32_t type = mesh ? scene.add_type(material, *mesh) : scene.add_type(material);
    scene.add_grains(spheres, type);
    scene.add_constant_light(1);
    scene.build();
    const double bytes =
        static_cast<double>(scene.device().bytes() - before) + static_cast<double>(scene.world().grains.bytes());
    const double per_grain = bytes / static_cast<double>(count);
    const BareScene bare(scene, mesh ? &*mesh : nullptr);
    const auto skip = static_cast<float>(1e-4 * scene.world().grains.radius(0));
    flush_subnormals();

    // In turns, so that a change of the machine's speed affects both.
    double ept_seconds = 0, bare_seconds = 0;
    uint64_t segments = 0, paths = 0, bare_segments = 0;
    for (uint32_t round = 0; ept_seconds < seconds_wanted && round < 100; ++round) {
        std::vector<Segment> recorded;
        std::vector<PathVertex> trail;
        const uint32_t first = static_cast<uint32_t>(paths);
        const auto start = Clock::now();
        uint64_t these = 0;
        while (these < 200000) {
            Sampler sampler(1, static_cast<uint32_t>(paths++), 0, 0);
            const auto [o, d] = start_ray(sampler);
            these += trace_path(scene.world(), scene.tracer(), o, d, sampler).segments;
        }
        ept_seconds += seconds_since(start);
        segments += these;
        for (uint32_t p = first; p < paths; ++p) {
            Sampler sampler(1, p, 0, 0);
            const auto [o, d] = start_ray(sampler);
            trail.clear();
            trace_path(scene.world(), scene.tracer(), o, d, sampler, {}, &trail);
            for (const PathVertex& v : trail) recorded.push_back({V3f(v.o), V3f(v.d)});
        }
        bare_seconds += bare.walk(recorded, skip);
        bare_segments += recorded.size();
    }
    const double ept = static_cast<double>(segments) / ept_seconds * 1e-6,
                 alone = static_cast<double>(bare_segments) / bare_seconds * 1e-6;
    fmt::print("{:<24} {:>9} {:>10.1f} {:>9.3f} {:>9.3f} {:>8.0f} % {:>10.1f}\n", name, count,
               static_cast<double>(segments) / static_cast<double>(paths), ept, alone, 100 * ept / alone, per_grain);
    std::fflush(stdout);
}

} // namespace
} // namespace scree

int main(int argc, char** argv)
{
    using namespace scree;
    const bool quick = argc > 1 && std::strcmp(argv[1], "--quick") == 0;
    const double seconds = quick ? 0.5 : 3;
    const auto tile = push_apart(12500, fraction, 0.8, 0.05, 1);
    const double edge = packing_edge(tile, fraction);
    fmt::print("Explicit path tracing on one thread, million segments a second, beside Embree's bare nearest hit\n");
    fmt::print("(spheres: sphere points; meshes: an instance a grain) over the same segments. Bed of fraction {}.\n\n",
               fraction);
    fmt::print("{:<24} {:>9} {:>10} {:>9} {:>9} {:>10} {:>10}\n", "grains", "number", "seg/path", "EPT", "bare",
               "EPT/bare", "bytes/grain");
    for (const uint64_t count : {uint64_t{100000}, uint64_t{1000000}}) {
        if (quick && count > 100000) break;
        const auto spheres = repeat_packing(tile, edge, count > 100000 ? 5 : 2, count);
        run("glass spheres", count, spheres, dielectric(1.5), std::nullopt, seconds);
        run("glass mesh 1,280", count, spheres, dielectric(1.5), icosphere(3), seconds);
        run("glass mesh 81,920", count, spheres, dielectric(1.5), icosphere(6), seconds);
        run("rough glass spheres", count, spheres, dielectric(1.5, 0.1), std::nullopt, seconds);
        run("diffuse spheres 0.9", count, spheres, lambert(0.9f), std::nullopt, seconds);
        run("diffuse mesh 1,280", count, spheres, lambert(0.9f), icosphere(3), seconds);
    }
    return 0;
}
