#include "render/grains/exemplar.h"

#include "base/error.h"
#include "ingest/meshes/enclosing_sphere.h"
#include "render/embree/embree_ray.h"
#include "render/embree/triangle.h"

namespace scree {

namespace {

/// What the filter needs to know of the ray; Embree passes the context to the filter.
struct Query {
    RTCIntersectContext context;
    const Exemplar* exemplar;
    V3d o, d;
    double rounding;
    uint32_t skip;
    float wanted; // sign of Ng . d that is accepted; 0: both
};

void keep_wanted_faces(const RTCFilterFunctionNArguments* args)
{
    const auto* query = reinterpret_cast<const Query*>(args->context);
    const auto* ray = reinterpret_cast<const RTCRay*>(args->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
    const float side = hit->Ng_x * ray->dir_x + hit->Ng_y * ray->dir_y + hit->Ng_z * ray->dir_z;
    if (hit->primID == query->skip || side * query->wanted < 0) args->valid[0] = 0;
    // Near the start, rounding can make the ray seem to enter a neighbour of `skip`, so double arithmetic decides. Rays
    // from inside need no test: at an edge they may really leave through the neighbour at once.
    else if (query->wanted <= 0 && query->skip != no_triangle && ray->tfar <= 0x1p-20f &&
             !meets_triangle(query->exemplar->corners(hit->primID), query->o, query->d, query->rounding)) {
        args->valid[0] = 0;
    }
}

} // namespace

Exemplar::Exemplar(const EmbreeDevice& device, const TriangleMesh& mesh, const std::string& place)
{
    const auto [centre, radius] = smallest_enclosing_sphere(mesh.positions);
    if (!(radius > 0)) throw InputError(place, "a mesh without extent", "a mesh with a size above 0");
    // Slightly smaller, so that no vertex is outside the unit sphere after rounding to float.
    const double scale = (1 - 0x1p-22) / radius;
    std::vector<V3f> positions;
    positions.reserve(mesh.positions.size());
    for (const V3d& p : mesh.positions) positions.emplace_back((p - centre) * scale);

    closed_ = is_closed_and_oriented(mesh);
    const bool inside_out = closed_ && signed_volume(mesh) < 0;

    scene_ = rtcNewScene(device.get());
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<V3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f), positions.size()));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), mesh.triangles.size()));
    device.check("building an exemplar");
    std::copy(positions.begin(), positions.end(), vertices);
    corners_.reserve(mesh.triangles.size());
    for (auto [a, b, c] : mesh.triangles) {
        if (inside_out) std::swap(b, c);
        indices = std::ranges::copy(std::array{a, b, c}, indices).out;
        corners_.push_back({positions[a], positions[b], positions[c]});
    }
    rtcSetGeometryIntersectFilterFunction(geometry, keep_wanted_faces);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    device.check("building an exemplar");
}

Exemplar::~Exemplar()
{
    if (scene_) rtcReleaseScene(scene_);
}

std::array<V3d, 3> Exemplar::corners(uint32_t triangle) const
{
    const auto& [a, b, c] = corners_[triangle];
    return {V3d(a), V3d(b), V3d(c)};
}

V3d Exemplar::point(const ExemplarHit& hit) const
{
    const auto [a, b, c] = corners(hit.triangle);
    return a + static_cast<double>(hit.u) * (b - a) + static_cast<double>(hit.v) * (c - a);
}

V3d Exemplar::normal(uint32_t triangle) const { return unit_normal(corners(triangle)); }

uint64_t Exemplar::bytes() const { return corners_.size() * sizeof(corners_[0]); }

bool Exemplar::intersect(const V3d& o, const V3d& d, double rounding, double tmax, Facing facing, uint32_t skip,
                         ExemplarHit& hit) const
{
    V3d start = o;
    if (skip != no_triangle) {
        // Rounding to float moves a coordinate of size <= 1 by up to 2^-25, and Embree's own subtraction rounds once
        // more. Move the start off the face by that bound, so that it is on the right side of the neighbours of `skip`.
        const V3d n = normal(skip);
        const double bound = 0x1p-23 * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
        start += std::copysign(bound, n.dot(d)) * n;
    }
    Query query;
    rtcInitIntersectContext(&query.context);
    query.exemplar = this;
    query.o = o;
    query.d = d;
    query.rounding = rounding;
    query.skip = skip;
    query.wanted = !closed_ ? 0.0f : facing == Facing::entering ? -1.0f : 1.0f;

    RTCRayHit ray = make_ray(start, d, tmax);
    rtcIntersect1(scene_, &query.context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit = {ray.ray.tfar, ray.hit.primID, ray.hit.u, ray.hit.v};
    return true;
}

} // namespace scree
