#include "render/trace/fill_tracer.h"

#include "render/embree/embree_ray.h"
#include "render/trace/tracer_impl.h"

#include <cmath>

namespace scree {

/// The data that a ray carries through Embree to the filter while it is in a cell.
struct FillTracer::Visit {
    RTCIntersectContext context; // first: Embree hands it back
    const FillTracer* tracer;
    TracerQuery* query;
    V3d o, d; // the ray from its own start, tile units, unit d
    FillCell cell;
    uint64_t number = 0;
    uint32_t variant = 0;
    double begin = 0,
           until = 0; // The visited part of the ray, tile units; Embree's ray is slightly longer at both ends.
    double start = 0; // start of Embree's ray, tile units along the ray
    double end = 0; // end of Embree's ray, tile units from its start
    bool starts_here = false; // the ray starts in this cell and may start inside a mesh grain's sphere

    /// Where Embree's ray may end, given the nearest hit so far.
    float embree_end() const
    {
        const double best = query->best * tracer->rate_ - start + tracer->margin_;
        return static_cast<float>(std::min(end, starts_here ? std::max(best, tracer->reach_) : best));
    }
};

namespace {

RTCGeometry make_spheres(const EmbreeDevice& device, const std::vector<GrainStore::Sphere>& spheres)
{
    RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* buffer = static_cast<GrainStore::Sphere*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(GrainStore::Sphere), spheres.size()));
    device.check("building a tile");
    std::copy(spheres.begin(), spheres.end(), buffer);
    return geometry;
}

} // namespace

void fill_filter(const RTCFilterFunctionNArguments* args)
{
    // rtcIntersect1 and rtcOccluded1 only: N is 1.
    auto& visit = *reinterpret_cast<FillTracer::Visit*>(args->context);
    auto* ray = reinterpret_cast<RTCRay*>(args->ray);
    const auto* hit = reinterpret_cast<const RTCHit*>(args->hit);
    const FillTracer& tracer = *visit.tracer;
    TracerQuery& query = *visit.query;
    args->valid[0] = 0;
    // Embree proposes a sphere by its near face if the ray still has to enter it, and by its far face alone if the ray
    // starts inside it.
    const bool far_face = hit->Ng_x * visit.d.x + hit->Ng_y * visit.d.y + hit->Ng_z * visit.d.z > 0;
    if (far_face && !visit.starts_here) return;

    const FillTracer::Entry& entry = tracer.variants_[visit.variant].entries[hit->primID];
    FillCell owner = visit.cell;
    uint64_t number = visit.number;
    if ((entry.dx | entry.dy | entry.dz) != 0) {
        owner = {owner.x + entry.dx, owner.y + entry.dy, owner.z + entry.dz};
        if (!tracer.fill_.has(owner)) return;
        number = tracer.fill_.number(owner);
    }
    const uint64_t id = tracer.fill_.id(number, entry.row);
    // A sphere of a neighbouring cell has the same position in every variant, so this cell's variant may be used.
    const ProceduralFill::Sphere placed = tracer.fill_.sphere(owner, visit.variant, entry.row);
    const GrainSphere sphere = tracer.world_.fill->to_render(placed);
    double t = 0;
    const bool enters = enters_sphere(sphere, query.o, query.d, t);
    if (enters ? far_face || t >= query.best : !visit.starts_here || (query.o - sphere.centre).length() > sphere.radius)
        return;
    if (!tracer.fill_.is_whole(number, entry.row, placed)) return;

    const Place place{HitKind::grain, id, no_triangle, tracer.world_.fill->type(id, placed)};
    if (tracer.world_.types[place.type].exemplar && !query.is_proxy(id)) {
        if (!query.offer_mesh(place, sphere)) return;
    } else {
        // A ray that leaves a convex grain cannot hit it again.
        if (query.from.kind == HitKind::grain && query.from.index == id) return;
        if (!enters) return;
        // A sphere that is entered in another visit attenuates in that visit.
        if (query.attenuates && !(t * tracer.rate_ >= visit.begin && t * tracer.rate_ < visit.until)) return;
        if (!query.offer_sphere(place, sphere, t)) return;
    }
    ray->tfar = visit.embree_end();
    args->valid[0] = -1;
}

FillTracer::FillTracer(std::shared_ptr<const EmbreeDevice> device, const World& world)
    : device_(std::move(device)), world_(world), fill_(world.fill->fill())
{
    const PackingTile& tile = fill_.tile();
    rate_ = world.space.world_length(1) / fill_.scale();
    const double extent = std::max({tile.size.x, tile.size.y, tile.size.z});
    const auto [least, largest] = std::minmax_element(tile.radius.begin(), tile.radius.end());
    // Spheres deviate from the lattice by the step of the fill's positions and by rounding to float in the scene.
    margin_ = 0x1p-19 * extent + 0x1p-22 * rate_ + fill_.voxel() * 0x1p-22 / fill_.scale();
    float_margin_ = FloatMargin(margin_ * 0x1p19, *least, *largest);
    step_back_ = float_margin_.step_back;
    const bool meshes = std::any_of(world.types.begin(), world.types.end(),
                                    [](const GrainType& type) { return type.exemplar != nullptr; });
    if (meshes) reach_ = 2.001 * *largest;
    variants_.resize(tile.variants.size());
    for (uint32_t variant = 0; variant < variants_.size(); ++variant) make_variant(variant);
    make_domain();
}

FillTracer::~FillTracer()
{
    for (const Variant& variant : variants_) rtcReleaseScene(variant.scene);
    rtcReleaseScene(domain_);
}

void FillTracer::make_variant(uint32_t number)
{
    const PackingTile& tile = fill_.tile();
    Variant& variant = variants_[number];
    std::vector<GrainStore::Sphere> spheres;
    for (uint32_t row = 0; row < tile.rows(); ++row) {
        const V3d& p = tile.variants[number][row];
        const double r = tile.radius[row];
        int first[3] = {0, 0, 0}, last[3] = {0, 0, 0};
        // Only spheres that all variants share certainly exist in the neighbouring cells. The others do not reach
        // beyond their own cell.
        const bool everywhere = row < tile.shared || tile.variants.size() == 1;
        for (int axis = 0; axis < 3 && everywhere; ++axis) {
            if (p[axis] - r <= margin_) last[axis] = 1;
            if (p[axis] + r >= tile.size[axis] - margin_) first[axis] = -1;
        }
        // The image at +size on an axis belongs to the next cell along it.
        for (int z = first[2]; z <= last[2]; ++z) {
            for (int y = first[1]; y <= last[1]; ++y) {
                for (int x = first[0]; x <= last[0]; ++x) {
                    spheres.push_back(
                        {static_cast<float>(p.x + x * tile.size.x), static_cast<float>(p.y + y * tile.size.y),
                         static_cast<float>(p.z + z * tile.size.z), float_margin_.widen(tile.radius[row])});
                    variant.entries.push_back(
                        {row, static_cast<int8_t>(x), static_cast<int8_t>(y), static_cast<int8_t>(z)});
                }
            }
        }
    }
    variant.scene = rtcNewScene(device_->get());
    rtcSetSceneFlags(variant.scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = make_spheres(*device_, spheres);
    rtcSetGeometryIntersectFilterFunction(geometry, fill_filter);
    rtcSetGeometryOccludedFilterFunction(geometry, fill_filter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(variant.scene, geometry, 0);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(variant.scene);
    device_->check("building a tile");
}

void FillTracer::make_domain()
{
    const TriangleMesh& mesh = fill_.domain().mesh();
    domain_ = rtcNewScene(device_->get());
    rtcSetSceneFlags(domain_, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<V3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               sizeof(V3f), mesh.positions.size()));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), mesh.triangles.size()));
    device_->check("building a domain");
    for (size_t i = 0; i < mesh.positions.size(); ++i) vertices[i] = V3f(world_.space.point(mesh.positions[i]));
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
        std::copy(mesh.triangles[i].begin(), mesh.triangles[i].end(), indices + 3 * i);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(domain_, geometry, 0);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(domain_);
    device_->check("building a domain");
}

/// A part of a ray that is inside the domain, as far as it is known: from begin to end (tile units along the ray).
struct FillTracer::Inside {
    double begin = 0, end = 0;
    bool goes_on = false; // the part goes on beyond `end`, up to the next crossing of the surface
};

bool FillTracer::next_crossing(const TracerQuery& query, double s, double end, Crossing& crossing) const
{
    const double t = s / rate_;
    const V3d start = query.o + t * query.d;
    RTCRayHit ray = make_ray(start, query.d, end / rate_ - t);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(domain_, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    const V3d normal(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z);
    const double cosine = normal.dot(query.d) / normal.length();
    // Rounding shifts the start and the surface against each other, which shifts the crossing along the ray by that
    // distance over the cosine. A ray almost parallel to the surface may be on either side of it.
    constexpr double least = 0x1p-10;
    const double margin = 0x1p-19 * (1 + start.length()) / std::max(std::abs(cosine), least);
    const double at = t + ray.ray.tfar;
    crossing = {std::max(s, (at - margin) * rate_), (at + margin) * rate_, cosine < -least};
    return true;
}

bool FillTracer::find_inside(const TracerQuery& query, double s, Inside& inside) const
{
    inside.begin = s;
    if (inside.goes_on) return true;
    Crossing crossing;
    if (!next_crossing(query, s, std::numeric_limits<double>::infinity(), crossing)) return false;
    inside.end = crossing.end;
    inside.goes_on = crossing.enters;
    if (crossing.enters) inside.begin = crossing.begin;
    return true;
}

void FillTracer::follow_inside(const TracerQuery& query, double end, Inside& inside) const
{
    if (!inside.goes_on || inside.end >= end) return;
    Crossing crossing;
    inside.goes_on = !next_crossing(query, std::max(inside.begin, inside.end), end, crossing);
    inside.end = inside.goes_on ? end : crossing.end;
}

bool FillTracer::reaches_domain(const TracerQuery& query, double& s) const
{
    const Imath::Box3d& bounds = fill_.domain().bounds();
    const V3d lo = world_.space.point(bounds.min), hi = world_.space.point(bounds.max);
    // Double rounds at 2^-53.
    const double margin = 0x1p-44 * (query.o.length() + lo.length() + hi.length());
    double begin = 0, end = query.best;
    for (int axis = 0; axis < 3; ++axis) {
        const double to_lo = lo[axis] - margin - query.o[axis], to_hi = hi[axis] + margin - query.o[axis];
        if (query.d[axis] == 0) {
            if (to_lo > 0 || to_hi < 0) return false;
            continue;
        }
        const double a = to_lo / query.d[axis], b = to_hi / query.d[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    s = begin * rate_;
    return begin <= end;
}

void FillTracer::walk(TracerQuery& query, bool any) const
{
    double s = query.beyond * rate_;
    Inside inside;
    // A ray that starts on a grain of the fill, or beyond a missed one, starts inside the domain.
    inside.goes_on = query.from.kind == HitKind::grain || query.beyond > 0;
    if (!inside.goes_on && !reaches_domain(query, s)) return;

    const double unit = world_.space.world_length(1);
    Visit visit;
    rtcInitIntersectContext(&visit.context);
    visit.tracer = this;
    visit.query = &query;
    visit.o = fill_.to_lattice(query.o * unit);
    visit.d = fill_.direction_to_lattice(query.d);
    const V3d size = fill_.tile().size;
    visit.cell = fill_.cell_at(visit.o + s * visit.d);
    while (s < query.best * rate_ && fill_.has(visit.cell)) {
        int out = 0;
        double leave = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            if (visit.d[axis] == 0) continue;
            const int64_t c = axis == 0 ? visit.cell.x : axis == 1 ? visit.cell.y : visit.cell.z;
            const double face = static_cast<double>(c + (visit.d[axis] > 0)) * size[axis];
            const double at = (face - visit.o[axis]) / visit.d[axis];
            if (at < leave) {
                leave = at;
                out = axis;
            }
        }
        leave = std::max(leave, s);
        visit.number = fill_.number(visit.cell);
        const ProceduralFill::CellKind kind = fill_.kind(visit.number);
        if (kind == ProceduralFill::CellKind::inside) {
            this->visit(visit, s, leave, any);
            if (any && query.place.kind != HitKind::none) return;
            inside = {leave, leave, true};
        } else {
            // Visits the parts of the ray inside the domain one by one.
            for (double from = s; from < leave && from < query.best * rate_; from = inside.end) {
                if (from >= inside.end && !find_inside(query, from, inside)) return;
                if (inside.begin >= leave) break;
                follow_inside(query, leave, inside);
                if (kind != ProceduralFill::CellKind::outside)
                    this->visit(visit, std::max(from, inside.begin), std::min(leave, inside.end), any);
                if (any && query.place.kind != HitKind::none) return;
            }
            if (inside.begin > leave) {
                s = inside.begin;
                visit.cell = fill_.cell_at(visit.o + s * visit.d);
                continue;
            }
        }
        s = leave;
        const int64_t step = visit.d[out] > 0 ? 1 : -1;
        (out == 0 ? visit.cell.x : out == 1 ? visit.cell.y : visit.cell.z) += step;
    }
}

void FillTracer::visit(Visit& visit, double begin, double end, bool any) const
{
    visit.variant = fill_.variant(visit.number);
    visit.begin = begin;
    visit.until = end;
    visit.start = begin - step_back_;
    visit.end = end + margin_ - visit.start;
    visit.starts_here = begin == 0 && reach_ > 0;
    if (visit.starts_here) visit.end = std::max(visit.end, reach_);
    const V3d size = fill_.tile().size;
    const V3d corner(static_cast<double>(visit.cell.x) * size.x, static_cast<double>(visit.cell.y) * size.y,
                     static_cast<double>(visit.cell.z) * size.z);
    RTCRayHit ray = make_ray(visit.o + visit.start * visit.d - corner, visit.d, 0);
    ray.ray.tfar = visit.embree_end();
    if (any)
        rtcOccluded1(variants_[visit.variant].scene, &visit.context, &ray.ray);
    else
        rtcIntersect1(variants_[visit.variant].scene, &visit.context, &ray);
}

} // namespace scree
