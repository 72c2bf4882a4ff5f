#include "render/scene/region_tracer.h"

#include "render/grains/triangle.h"
#include "render/scene/embree_device.h"
#include "render/scene/embree_ray.h"

#include <limits>

namespace scree {

namespace {

std::array<V3d, 3> corners_of(const MediumRegion& region, uint32_t triangle)
{
    const auto& t = region.triangles[triangle];
    return {V3d(region.positions[t[0]]), V3d(region.positions[t[1]]), V3d(region.positions[t[2]])};
}

/// What a ray carries through Embree, and the nearest crossing so far.
struct CrossingQuery {
    RTCIntersectContext context; // first: Embree hands it back
    const World* world;
    V3d o, d;
    double tmin, best, advanced; // Embree's ray starts at o + advanced d
    double slack;                // what rounding to float may move a crossing by
    const Crossing* last;
    Crossing crossing;
    bool found = false;
};

void crossing_filter(const RTCFilterFunctionNArguments* args)
{
    auto& query = *reinterpret_cast<CrossingQuery*>(args->context);
    auto* ray = reinterpret_cast<RTCRay*>(args->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
    args->valid[0] = 0;
    const auto c = corners_of(query.world->regions[hit->geomID], hit->primID);
    const double t = meet_plane(c, query.o, query.d).t;
    // Where surfaces coincide they are gone through in order of their numbers.
    const std::pair which{hit->geomID, hit->primID};
    if (query.last && which == std::pair{query.last->region, query.last->triangle}) return;
    const bool due = t > query.tmin || (query.last && t == query.tmin && which > std::pair{query.last->region, query.last->triangle});
    const bool first = t < query.best || (query.found && t == query.best && which < std::pair{query.crossing.region, query.crossing.triangle});
    if (!due || !first) return;
    query.best = t;
    query.found = true;
    query.crossing = {t, hit->geomID, hit->primID, (c[1] - c[0]).cross(c[2] - c[0]).dot(query.d) < 0};
    ray->tfar = static_cast<float>(std::max(0.0, t - query.advanced) + query.slack);
    args->valid[0] = -1;
}

} // namespace

struct RegionTracer::Impl {
    std::shared_ptr<const EmbreeDevice> device;
    const World& world;
    RTCScene scene = nullptr;
    V3d middle{0};
    double radius = 0; // around the middle, of all regions

    Impl(std::shared_ptr<const EmbreeDevice> device_, const World& world_);
    ~Impl()
    {
        if (scene) rtcReleaseScene(scene);
    }
};

RegionTracer::Impl::Impl(std::shared_ptr<const EmbreeDevice> device_, const World& world_) : device(std::move(device_)), world(world_)
{
    scene = rtcNewScene(device->get());
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    for (uint32_t i = 0; i < world.regions.size(); ++i) {
        const MediumRegion& region = world.regions[i];
        RTCGeometry geometry = rtcNewGeometry(device->get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<V3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f), region.positions.size()));
        auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), region.triangles.size()));
        device->check("building the surface of a medium");
        std::copy(region.positions.begin(), region.positions.end(), vertices);
        for (size_t t = 0; t < region.triangles.size(); ++t) std::copy(region.triangles[t].begin(), region.triangles[t].end(), indices + 3 * t);
        rtcSetGeometryIntersectFilterFunction(geometry, crossing_filter);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, i);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
    device->check("building the surfaces of media");
    RTCBounds bounds;
    rtcGetSceneBounds(scene, &bounds);
    const V3d lo(bounds.lower_x, bounds.lower_y, bounds.lower_z), hi(bounds.upper_x, bounds.upper_y, bounds.upper_z);
    middle = 0.5 * (lo + hi);
    radius = 0.5 * (hi - lo).length();
}

RegionTracer::RegionTracer(std::shared_ptr<const EmbreeDevice> device, const World& world) : impl_(std::make_unique<Impl>(std::move(device), world))
{
    for (size_t i = 0; i < world.regions.size(); ++i) {
        if (world.regions[i].instead_of_grains) instead_of_grains_ |= RegionSet{1} << i;
    }
    clearance_ = world.clearance.get();
}

RegionTracer::~RegionTracer() = default;

V3d RegionTracer::normal(const Crossing& crossing) const
{
    return unit_normal(corners_of(impl_->world.regions[crossing.region], crossing.triangle));
}

bool RegionTracer::next(const V3d& o, const V3d& d, double tmin, double tmax, const Crossing* last, Crossing& crossing) const
{
    // What rounding to float may do to a ray: it starts that much early, and not farther away than a few times the regions' size.
    const V3d to = impl_->middle - o;
    const double reach = impl_->radius * (1 + 0x1p-10), along = to.dot(d);
    if (along + reach < tmin || along - reach > tmax || (to - along * d).length2() > reach * reach) return false;
    CrossingQuery query;
    rtcInitIntersectContext(&query.context);
    query.world = &impl_->world;
    query.o = o;
    query.d = d;
    query.tmin = tmin;
    query.best = tmax;
    query.last = last;
    query.slack = 0x1p-20 * (impl_->middle.length() + reach);
    // A ray nearly along a face needs a long way back to be on its near side for certain, whatever rounding does to its start.
    query.advanced = std::max(tmin, along - reach) - 0x1p10 * query.slack;
    RTCRayHit ray = make_ray(o + query.advanced * d, d, tmax - query.advanced + query.slack);
    rtcIntersect1(impl_->scene, &query.context, &ray);
    if (query.found) crossing = query.crossing;
    return query.found;
}

RegionSet RegionTracer::inside(const V3d& o, const V3d& d) const
{
    RegionSet in = 0, met = 0;
    Crossing crossing;
    const Crossing* last = nullptr;
    for (double t = 0; next(o, d, t, std::numeric_limits<double>::infinity(), last, crossing); t = crossing.t, last = &crossing) {
        const RegionSet bit = RegionSet{1} << crossing.region;
        if (!(met & bit) && !crossing.enters) in |= bit;
        met |= bit;
    }
    return in;
}

RegionSet RegionTracer::after(RegionSet from, const V3d& a, const V3d& b) const
{
    const V3d way = b - a;
    const double length = way.length();
    if (!(length > 0)) return from;
    const V3d d = way / length;
    Crossing crossing;
    const Crossing* last = nullptr;
    for (double t = 0; next(a, d, t, length, last, crossing); t = crossing.t, last = &crossing) from = after(from, crossing);
    return from;
}

} // namespace scree
