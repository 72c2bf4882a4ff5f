#include "render/trace/region_tracer.h"

#include "render/embree/embree_device.h"
#include "render/embree/embree_ray.h"
#include "render/embree/triangle.h"

#include <cmath>
#include <limits>

namespace scree {

namespace {

std::array<V3d, 3> corners_of(const MediumRegion& region, uint32_t triangle)
{
    const auto& t = region.triangles[triangle];
    return {V3d(region.positions[t[0]]), V3d(region.positions[t[1]]), V3d(region.positions[t[2]])};
}

/// Where o + t d hits a triangle; false if the ray passes beside it or lies in its plane.
///
/// The side of an edge on which a ray passes is the sign of a volume. Two triangles that share the edge compute the
/// same number, so no ray passes between them (Platis and Theoharis 2003, in double). A ray exactly through the edge is
/// treated as if its start were moved aside infinitesimally (Edelsbrunner and Mücke 1990).
bool meets(const std::array<V3d, 3>& corners, const V3d& o, const V3d& d, double& t, bool& enters)
{
    const V3d a = corners[0] - o, b = corners[1] - o, c = corners[2] - o;
    const double u = d.dot(b.cross(c)), v = d.dot(c.cross(a)), w = d.dot(a.cross(b));
    const auto is_left = [&d](double volume, const V3d& from, const V3d& to) {
        if (volume != 0) return volume > 0;
        const V3d aside = (from - to).cross(d);
        return aside.x != 0 ? aside.x > 0 : aside.y != 0 ? aside.y > 0 : aside.z > 0;
    };
    const bool left = is_left(u, b, c);
    if (left != is_left(v, c, a) || left != is_left(w, a, b)) return false;
    const double sum = u + v + w;
    if (sum == 0) return false;
    t = d.dot(u * a + v * b + w * c) / sum;
    enters = !left;
    return true;
}

/// The data that a ray carries through Embree, and the nearest crossing so far.
struct CrossingQuery {
    RTCIntersectContext context; // first: Embree hands it back
    const World& world;
    V3d o, d;
    // Triangles are tested from o + ahead d on, which is near the regions, so that double is precise there.
    double ahead;
    double tmin, best, advanced; // Embree's ray starts at o + advanced d
    double slack; // the largest shift of a crossing by rounding to float
    const Crossing* last;
    Crossing crossing{};
    bool found = false;
    // Embree hit a triangle that the exact ray misses; the ray may hit a neighbour of that triangle instead.
    bool doubtful = false;

    /// Whether the ray hits this triangle nearer than all so far; if so, Embree's ray is shortened to the hit.
    bool offer(uint32_t region, uint32_t triangle, RTCRay& embree)
    {
        Crossing met{0, region, triangle, false};
        if (!meets(corners_of(world.regions[region], triangle), o + ahead * d, d, met.t, met.enters)) {
            doubtful = true;
            return false;
        }
        met.t += ahead;
        // Coincident surfaces are crossed in the order of their numbers.
        const auto number = [](const Crossing& of) { return std::pair{of.region, of.triangle}; };
        if (last && number(met) == number(*last)) return false;
        const bool due = met.t > tmin || (last && met.t == tmin && number(met) > number(*last));
        const bool first = met.t < best || (found && met.t == best && number(met) < number(crossing));
        if (!due || !first) return false;
        best = met.t;
        found = true;
        crossing = met;
        embree.tfar = static_cast<float>(std::max(0.0, met.t - advanced) + slack);
        return true;
    }
};

void filter_triangle(const RTCFilterFunctionNArguments* args)
{
    const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
    auto& query = *reinterpret_cast<CrossingQuery*>(args->context);
    args->valid[0] = query.offer(hit->geomID, hit->primID, *reinterpret_cast<RTCRay*>(args->ray)) ? -1 : 0;
}

void meet_box(const RTCIntersectFunctionNArguments* args)
{
    auto& query = *reinterpret_cast<CrossingQuery*>(args->context);
    query.offer(args->geomID, args->primID, reinterpret_cast<RTCRayHit*>(args->rayhit)->ray);
}

/// The surface of a region as boxes for Embree, widened so that every ray that hits a triangle also hits its box, in
/// spite of rounding to float.
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
    RTCScene triangles = nullptr; // fast; exact only for rays rounded to float
    // boxes of triangles: a triangle that a ray hits in double is in a box that it hits in float
    RTCScene boxes = nullptr;
    Imath::Box3d box; // of all regions
    V3d middle{0};
    double radius = 0; // around the middle
    double slack = 0; // the largest shift of a ray by rounding to float

    Impl(std::shared_ptr<const EmbreeDevice> device_, const World& world_);
    ~Impl()
    {
        if (triangles) rtcReleaseScene(triangles);
        if (boxes) rtcReleaseScene(boxes);
    }
    void find(CrossingQuery& query, RTCScene scene) const;

private:
    void add(RTCScene scene, RTCGeometry geometry, uint32_t number) const
    {
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, number);
        rtcReleaseGeometry(geometry);
    }
};

RegionTracer::Impl::Impl(std::shared_ptr<const EmbreeDevice> device_, const World& world_)
    : device(std::move(device_)), world(world_)
{
    for (const MediumRegion& region : world.regions) box.extendBy(region.bounds());
    middle = box.center();
    radius = 0.5 * box.size().length();
    slack = 0x1p-20 * (middle.length() + radius);
    for (RTCScene* scene : {&triangles, &boxes}) {
        *scene = rtcNewScene(device->get());
        rtcSetSceneFlags(*scene, RTC_SCENE_FLAG_ROBUST);
    }
    rtcSetSceneBuildQuality(boxes, RTC_BUILD_QUALITY_LOW); // hardly any ray uses this scene
    std::vector<WidenedSurface> surfaces;
    surfaces.reserve(world.regions.size()); // Embree keeps pointers to the elements
    for (uint32_t i = 0; i < world.regions.size(); ++i) {
        const MediumRegion& region = world.regions[i];
        RTCGeometry quick = rtcNewGeometry(device->get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<V3f*>(rtcSetNewGeometryBuffer(quick, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                   sizeof(V3f), region.positions.size()));
        auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            quick, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), region.triangles.size()));
        device->check("building the surface of a medium");
        std::copy(region.positions.begin(), region.positions.end(), vertices);
        for (size_t t = 0; t < region.triangles.size(); ++t)
            std::copy(region.triangles[t].begin(), region.triangles[t].end(), indices + 3 * t);
        rtcSetGeometryIntersectFilterFunction(quick, filter_triangle);
        add(triangles, quick, i);

        RTCGeometry sure = rtcNewGeometry(device->get(), RTC_GEOMETRY_TYPE_USER);
        surfaces.push_back({&region, slack});
        rtcSetGeometryUserPrimitiveCount(sure, static_cast<unsigned>(region.triangles.size()));
        rtcSetGeometryUserData(sure, &surfaces.back());
        rtcSetGeometryBoundsFunction(sure, WidenedSurface::bound, nullptr);
        rtcSetGeometryIntersectFunction(sure, meet_box);
        add(boxes, sure, i);
    }
    rtcCommitScene(triangles);
    rtcCommitScene(boxes);
    device->check("building the surfaces of media");
}

/// Embree's ray starts up to `slack` early and ends `slack` late, because rounding to float may shift it by that much.
void RegionTracer::Impl::find(CrossingQuery& query, RTCScene scene) const
{
    RTCRayHit ray = make_ray(query.o + query.advanced * query.d, query.d, query.best - query.advanced + query.slack);
    rtcIntersect1(scene, &query.context, &ray);
}

RegionTracer::RegionTracer(std::shared_ptr<const EmbreeDevice> device, const World& world)
    : impl_(std::make_unique<Impl>(std::move(device), world))
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

bool RegionTracer::find(const V3d& o, const V3d& d, double tmin, double tmax, const Crossing* last, bool& surely,
                        Crossing& crossing) const
{
    // Embree's ray starts near the regions: within about their own size.
    const V3d to = impl_->middle - o;
    const double reach = impl_->radius * (1 + 0x1p-10), along = to.dot(d);
    if (along + reach < tmin || along - reach > tmax || (to - along * d).length2() > reach * reach) return false;
    const double start = std::max(tmin, along - reach), slack = 4 * impl_->slack;
    // A ray almost parallel to a face must start far back to be on the face's near side in float too.
    CrossingQuery query{{},   impl_->world,          o,     d,   std::max(0.0, along - reach), tmin,
                        tmax, start - 0x1p8 * slack, slack, last};
    rtcInitIntersectContext(&query.context);
    if (!surely) {
        impl_->find(query, impl_->triangles);
        surely = query.doubtful;
    }
    if (surely) {
        query.best = tmax;
        query.found = false;
        query.advanced = start - slack;
        impl_->find(query, impl_->boxes);
    }
    if (query.found) crossing = query.crossing;
    return query.found;
}

bool RegionTracer::next(const V3d& o, const V3d& d, double tmin, double tmax, const Crossing* last, RegionSet& regions,
                        Crossing& crossing) const
{
    // The crossings ahead tell in which regions the ray is. If it is in a region, there must be a crossing ahead, so
    // the search goes on beyond tmax.
    const double end = regions != 0 ? std::numeric_limits<double>::infinity() : tmax;
    Crossing ahead; // a separate variable, as `last` may point to `crossing`
    bool surely = false, crosses = find(o, d, tmin, end, last, surely, ahead);
    const auto told = [&] { return before(regions, crosses ? &ahead : nullptr); };
    if (crosses || std::isinf(end)) {
        if (told() != regions && !surely) crosses = find(o, d, tmin, end, last, surely = true, ahead);
        regions = told();
    }
    if (!crosses || ahead.t >= tmax) return false;
    crossing = ahead;
    return true;
}

RegionSet RegionTracer::inside(const V3d& o, const V3d& d) const
{
    RegionSet in = 0, met = 0;
    if (!impl_->box.intersects(o)) return in; // the case of most cameras
    Crossing crossing;
    const Crossing* last = nullptr;
    bool surely = true; // a missed crossing may be the only one
    for (double t = 0; find(o, d, t, std::numeric_limits<double>::infinity(), last, surely, crossing);
         t = crossing.t, last = &crossing) {
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
    for (double t = 0; next(a, d, t, length, last, from, crossing); t = crossing.t, last = &crossing)
        from = after(from, crossing);
    return from;
}

} // namespace scree
