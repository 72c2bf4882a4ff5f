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

/// A ray along which triangles are seen in a plane, sheared so that it is a point there (Woop, Benthin and Wald 2013, in double): of two triangles
/// that share an edge the same number says on which side of it the ray passes, so that no ray goes between them.
struct ShearedRay {
    V3d o;
    int x, y, z; // axes of the plane, and the one that the ray goes along most
    double shear_x, shear_y, along;

    ShearedRay(const V3d& o_, const V3d& d) : o(o_)
    {
        z = std::abs(d.x) > std::abs(d.y) ? 0 : 1;
        if (std::abs(d.z) > std::abs(d[z])) z = 2;
        x = (z + 1) % 3;
        y = (z + 2) % 3;
        if (d[z] < 0) std::swap(x, y);
        shear_x = d[x] / d[z];
        shear_y = d[y] / d[z];
        along = d[z];
    }

    /// False where the ray passes beside the triangle or within its plane.
    bool meets(const std::array<V3d, 3>& corners, double& t, bool& enters) const
    {
        const V3d a = corners[0] - o, b = corners[1] - o, c = corners[2] - o;
        const double ax = a[x] - shear_x * a[z], ay = a[y] - shear_y * a[z], bx = b[x] - shear_x * b[z], by = b[y] - shear_y * b[z];
        const double cx = c[x] - shear_x * c[z], cy = c[y] - shear_y * c[z];
        const double u = cx * by - cy * bx, v = ax * cy - ay * cx, w = bx * ay - by * ax;
        if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
        const double sum = u + v + w;
        if (sum == 0) return false;
        t = (u * a[z] + v * b[z] + w * c[z]) / (sum * along);
        enters = sum > 0;
        return true;
    }
};

/// What a ray carries through Embree, and the nearest crossing so far.
struct CrossingQuery {
    RTCIntersectContext context; // first: Embree hands it back
    const World& world;
    ShearedRay ray;
    double tmin, best, advanced; // Embree's ray starts at o + advanced d
    double slack;                // what rounding to float may move a crossing by
    const Crossing* last;
    Crossing crossing{};
    bool found = false;
};

void find_crossing(const RTCIntersectFunctionNArguments* args)
{
    auto& query = *reinterpret_cast<CrossingQuery*>(args->context);
    Crossing crossing{0, args->geomID, args->primID, false};
    if (!query.ray.meets(corners_of(query.world.regions[crossing.region], crossing.triangle), crossing.t, crossing.enters)) return;
    // Where surfaces coincide they are gone through in order of their numbers.
    const auto number = [](const Crossing& of) { return std::pair{of.region, of.triangle}; };
    if (query.last && number(crossing) == number(*query.last)) return;
    const bool due = crossing.t > query.tmin || (query.last && crossing.t == query.tmin && number(crossing) > number(*query.last));
    const bool first = crossing.t < query.best || (query.found && crossing.t == query.best && number(crossing) < number(query.crossing));
    if (!due || !first) return;
    query.best = crossing.t;
    query.found = true;
    query.crossing = crossing;
    reinterpret_cast<RTCRayHit*>(args->rayhit)->ray.tfar = static_cast<float>(std::max(0.0, crossing.t - query.advanced) + query.slack);
}

/// The surface of a region as Embree is told of it: no ray that meets a triangle passes by its box, whatever rounding to float does to either.
struct WidenedSurface {
    const MediumRegion* region;
    double slack;

    static void bound(const RTCBoundsFunctionArguments* args)
    {
        const auto& surface = *static_cast<const WidenedSurface*>(args->geometryUserPtr);
        Imath::Box3d box;
        for (const V3d& corner : corners_of(*surface.region, args->primID)) box.extendBy(corner);
        const V3f low(box.min - V3d(surface.slack)), high(box.max + V3d(surface.slack));
        *args->bounds_o = {low.x, low.y, low.z, 0, high.x, high.y, high.z, 0};
    }
};

} // namespace

struct RegionTracer::Impl {
    std::shared_ptr<const EmbreeDevice> device;
    const World& world;
    RTCScene scene = nullptr;
    V3d middle{0};
    double radius = 0; // around the middle, of all regions
    double slack = 0;  // what rounding of a ray to float may move it by

    Impl(std::shared_ptr<const EmbreeDevice> device_, const World& world_);
    ~Impl()
    {
        if (scene) rtcReleaseScene(scene);
    }
};

RegionTracer::Impl::Impl(std::shared_ptr<const EmbreeDevice> device_, const World& world_) : device(std::move(device_)), world(world_)
{
    Imath::Box3d box;
    for (const MediumRegion& region : world.regions) box.extendBy(region.bounds());
    middle = box.center();
    radius = 0.5 * box.size().length();
    slack = 0x1p-20 * (middle.length() + radius);
    scene = rtcNewScene(device->get());
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    std::vector<WidenedSurface> surfaces;
    surfaces.reserve(world.regions.size()); // Embree keeps where they are
    for (uint32_t i = 0; i < world.regions.size(); ++i) {
        const MediumRegion& region = world.regions[i];
        RTCGeometry geometry = rtcNewGeometry(device->get(), RTC_GEOMETRY_TYPE_USER);
        surfaces.push_back({&region, slack});
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(region.triangles.size()));
        rtcSetGeometryUserData(geometry, &surfaces.back());
        rtcSetGeometryBoundsFunction(geometry, WidenedSurface::bound, nullptr);
        rtcSetGeometryIntersectFunction(geometry, find_crossing);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, i);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
    device->check("building the surfaces of media");
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
    const V3d to = impl_->middle - o;
    const double reach = impl_->radius * (1 + 0x1p-10), along = to.dot(d);
    if (along + reach < tmin || along - reach > tmax || (to - along * d).length2() > reach * reach) return false;
    // What rounding to float may do to a ray: it starts that much early, and not farther away than the regions' size.
    const double slack = 4 * impl_->slack;
    CrossingQuery query{{}, impl_->world, {o, d}, tmin, tmax, std::max(tmin, along - reach) - slack, slack, last};
    rtcInitIntersectContext(&query.context);
    RTCRayHit ray = make_ray(o + query.advanced * d, d, tmax - query.advanced + slack);
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
