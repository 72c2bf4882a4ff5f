#include "render/trace/tracer_impl.h"

#include <algorithm>
#include <cmath>

namespace scree {

Tracer::Impl::Impl(std::shared_ptr<const EmbreeDevice> device_, const World& world_)
    : device(std::move(device_)), world(world_)
{
    scene = rtcNewScene(device->get());
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);

    const GrainStore& grains = world.grains;
    if (SizeClasses::are_needed(grains)) {
        sizes = std::make_unique<SizeClasses>(*device, grains);
    } else {
        attach_grains(analytic_id, 0, grains.analytic_count);
        attach_grains(mesh_id, grains.analytic_count, grains.size() - grains.analytic_count);
    }
    for (uint32_t i = grains.analytic_count; i < grains.size(); ++i)
        mesh_reach = std::max(mesh_reach, 2.001 * grains.radius(i));

    const bool inside_possible = std::any_of(world.types.begin(), world.types.end(), [](const GrainType& type) {
        return type.material.transmits() || type.gsdf;
    });
    if (inside_possible && world.has_grains() && !world.surfaces.empty()) {
        surface_scene = rtcNewScene(device->get());
        rtcSetSceneFlags(surface_scene, RTC_SCENE_FLAG_ROBUST);
    }
    const bool some_replaced = std::ranges::any_of(world.regions, &MediumRegion::instead_of_grains);
    if (some_replaced) {
        largest_radius = world.fill ? world.fill->largest_radius() : 0;
        for (uint64_t i = 0; i < grains.size(); ++i)
            largest_radius = std::max<double>(largest_radius, grains.radius(i));
    }
    if (some_replaced && grains.size() > 0) {
        open_scene = rtcNewScene(device->get());
        rtcSetSceneFlags(open_scene, RTC_SCENE_FLAG_ROBUST);
    }
    uint32_t id = first_surface;
    for (const Surface& surface : world.surfaces) {
        RTCGeometry geometry = make_surface(surface);
        attach(scene, geometry, id);
        if (surface_scene) attach(surface_scene, geometry, id);
        if (open_scene) attach(open_scene, geometry, id);
        rtcReleaseGeometry(geometry);
        ++id;
    }
    first_light = id;
    const auto& lights = world.lights.lights();
    for (uint32_t i = 0; i < lights.size(); ++i) {
        if (lights[i].is_infinite()) continue;
        RTCGeometry geometry = make_light(lights[i]);
        attach(scene, geometry, id);
        if (open_scene) attach(open_scene, geometry, id);
        ++id;
        rtcReleaseGeometry(geometry);
        light_of_id.push_back(i);
    }
    rtcCommitScene(scene);
    if (surface_scene) rtcCommitScene(surface_scene);
    if (open_scene) rtcCommitScene(open_scene);
    device->check("building the scene's acceleration structure");

    RTCBounds bounds;
    rtcGetSceneBounds(scene, &bounds);
    const auto farthest = [](float lo, float hi) { return std::max(std::abs(double{lo}), std::abs(double{hi})); };
    V3d far(0);
    if (bounds.lower_x <= bounds.upper_x) {
        far = V3d(farthest(bounds.lower_x, bounds.upper_x), farthest(bounds.lower_y, bounds.upper_y),
                  farthest(bounds.lower_z, bounds.upper_z));
    }
    for (uint32_t i = 0; sizes && i < grains.size(); ++i) {
        const V3d c = grains.centre(i);
        for (int axis = 0; axis < 3; ++axis) far[axis] = std::max(far[axis], std::abs(c[axis]) + grains.radius(i));
    }
    if (world.domain) {
        const V3d lo = world.domain->min, hi = world.domain->max;
        for (int axis = 0; axis < 3; ++axis) far[axis] = std::max({far[axis], std::abs(lo[axis]), std::abs(hi[axis])});
    }
    radius = far.length();
    if (!world.regions.empty()) regions = std::make_unique<RegionTracer>(device, world);
    if (world.fill) fill = std::make_unique<FillTracer>(device, world);
}

Tracer::Impl::~Impl()
{
    if (surface_scene) rtcReleaseScene(surface_scene);
    if (open_scene) rtcReleaseScene(open_scene);
    if (scene) rtcReleaseScene(scene);
}

void Tracer::Impl::attach(RTCScene to, RTCGeometry geometry, uint32_t id) const
{
    rtcSetGeometryIntersectFilterFunction(geometry, tracer_filter);
    rtcSetGeometryOccludedFilterFunction(geometry, tracer_filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(to, geometry, id);
}

void Tracer::Impl::attach_grains(uint32_t id, size_t begin, size_t count)
{
    if (count == 0) return;
    RTCGeometry geometry = rtcNewGeometry(device->get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, world.grains.spheres.data(),
                               begin * sizeof(GrainStore::Sphere), sizeof(GrainStore::Sphere), count);
    attach(scene, geometry, id);
    rtcReleaseGeometry(geometry);
}

RTCGeometry Tracer::Impl::make_surface(const Surface& surface) const
{
    RTCGeometry geometry = rtcNewGeometry(device->get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<V3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               sizeof(V3f), surface.positions.size()));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), surface.triangles.size()));
    device->check("building a surface");
    std::copy(surface.positions.begin(), surface.positions.end(), vertices);
    for (size_t i = 0; i < surface.triangles.size(); ++i) {
        std::copy(surface.triangles[i].begin(), surface.triangles[i].end(), indices + 3 * i);
    }
    return geometry;
}

RTCGeometry Tracer::Impl::make_light(const Light& light) const
{
    if (light.kind == LightKind::sphere) {
        RTCGeometry geometry = rtcNewGeometry(device->get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto* sphere = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1));
        device->check("building a light");
        const V3f c(light.center);
        std::copy_n(std::array<float, 4>{c.x, c.y, c.z, static_cast<float>(light.radius)}.begin(), 4, sphere);
        return geometry;
    }
    RTCGeometry geometry = rtcNewGeometry(device->get(), RTC_GEOMETRY_TYPE_QUAD);
    auto* vertices = static_cast<V3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f), 4));
    auto* indices = static_cast<uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(uint32_t), 1));
    device->check("building a light");
    vertices[0] = V3f(light.corner);
    vertices[1] = V3f(light.corner + light.edge1);
    vertices[2] = V3f(light.corner + light.edge1 + light.edge2);
    vertices[3] = V3f(light.corner + light.edge2);
    for (uint32_t i = 0; i < 4; ++i) indices[i] = i;
    return geometry;
}

} // namespace scree
