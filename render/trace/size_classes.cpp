#include "render/trace/size_classes.h"

#include "render/embree/embree_ray.h"
#include "render/trace/tracer_impl.h"

#include <cmath>
#include <map>

namespace scree {

namespace {

constexpr int octaves = 6; // factors of two between the radii of a class

/// Sets the bounds, the margin and the Embree scene of a class: spheres first, then meshes.
void build_class(const EmbreeDevice& device, const GrainStore& grains, size_t spheres_in_it, SizeClass& size)
{
    V3d lo(std::numeric_limits<double>::infinity()), hi = -lo;
    double least = std::numeric_limits<double>::infinity(), largest = 0;
    for (const uint32_t grain : size.grains) {
        const V3d c = grains.centre(grain);
        const double r = grains.radius(grain);
        for (int axis = 0; axis < 3; ++axis) {
            lo[axis] = std::min(lo[axis], c[axis] - r);
            hi[axis] = std::max(hi[axis], c[axis] + r);
        }
        least = std::min(least, r);
        largest = std::max(largest, r);
    }
    size.centre = 0.5 * (lo + hi);
    size.reach = 0.5 * (hi - lo).length() * (1 + 0x1p-10);
    size.margin = FloatMargin(size.reach, least, largest);
    size.scene = rtcNewScene(device.get());
    rtcSetSceneFlags(size.scene, RTC_SCENE_FLAG_ROBUST);
    const auto attach = [&](uint32_t id, size_t begin, size_t end) {
        if (begin == end) return;
        RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto* buffer = static_cast<GrainStore::Sphere*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(GrainStore::Sphere), end - begin));
        device.check("building grains");
        for (size_t i = begin; i < end; ++i) {
            const V3f c(grains.centre(size.grains[i]) - size.centre);
            buffer[i - begin] = {c.x, c.y, c.z, size.margin.widen(static_cast<float>(grains.radius(size.grains[i])))};
        }
        rtcSetGeometryIntersectFilterFunction(geometry, tracer_filter);
        rtcSetGeometryOccludedFilterFunction(geometry, tracer_filter);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(size.scene, geometry, id);
        rtcReleaseGeometry(geometry);
    };
    attach(Tracer::Impl::analytic_id, 0, spheres_in_it);
    attach(Tracer::Impl::mesh_id, spheres_in_it, size.grains.size());
    if (spheres_in_it < size.grains.size()) size.mesh_reach = 2.001 * largest;
    size.spheres = static_cast<uint32_t>(spheres_in_it);
    rtcCommitScene(size.scene);
    device.check("building grains");
}

} // namespace

bool SizeClasses::are_needed(const GrainStore& grains)
{
    double least = std::numeric_limits<double>::infinity(), largest = 0;
    for (uint32_t i = 0; i < grains.size(); ++i) {
        least = std::min(least, grains.radius(i));
        largest = std::max(largest, grains.radius(i));
    }
    return largest > widest * least;
}

SizeClasses::SizeClasses(const EmbreeDevice& device, const GrainStore& grains)
{
    std::map<int, std::vector<uint32_t>> by_size;
    std::map<int, size_t> spheres;
    for (uint32_t i = 0; i < grains.size(); ++i) {
        const int octave = std::ilogb(grains.radius(i)) + 1024, number = octave / octaves;
        by_size[number].push_back(i);
        spheres[number] += i < grains.analytic_count; // spheres come first in the store
    }
    classes_.reserve(by_size.size());
    for (auto& [number, members] : by_size) {
        SizeClass& size = classes_.emplace_back();
        size.grains = std::move(members);
        build_class(device, grains, spheres[number], size);
    }
}

SizeClasses::~SizeClasses()
{
    for (const SizeClass& size : classes_) rtcReleaseScene(size.scene);
}

void SizeClasses::find(TracerQuery& query, bool any) const
{
    for (const SizeClass& size : classes_) {
        double entry = 0;
        const bool is_far = (query.o - size.centre).length2() > 4 * size.reach * size.reach;
        if (is_far && !enters_sphere({size.centre, size.reach}, query.o, query.d, entry)) continue;
        query.advanced = std::max(query.beyond, entry) - size.margin.step_back;
        if (is_far && query.best <= query.advanced) continue;
        query.reach = is_far ? 0 : size.mesh_reach; // a start this far out is in no sphere
        query.sized = &size;
        RTCRayHit ray = make_ray(query.o + query.advanced * query.d - size.centre, query.d, query.embree_end());
        if (any) {
            rtcOccluded1(size.scene, &query.context, &ray.ray);
            if (query.place.kind != HitKind::none) break;
        } else {
            rtcIntersect1(size.scene, &query.context, &ray);
        }
    }
    query.sized = nullptr;
}

} // namespace scree
