#include "packing/solids/domain.h"

#include "base/error.h"
#include "ingest/meshes/mesh_topology.h"
#include "packing/solids/mesh_defects.h"
#include "packing/solids/mesh_shells.h"

#include <algorithm>
#include <cmath>

namespace scree {

using Imath::V3d;

struct Domain::Impl {
    TriangleMesh mesh;
    std::string place;
    Imath::Box3d bounds;
    double volume = 0;
    std::optional<SurfaceTree> tree;

    [[noreturn]] void fail(const MeshDefect& defect) const
    {
        throw InputError(place, defect.found, "a closed, oriented mesh without self-intersections", defect.hint);
    }
};

namespace {

/// The volume by the divergence theorem. In extended precision, because thin walls leave a small difference of large
/// sums. Scaled to about 1 and back, so that only a result that is too large for a double overflows.
double enclosed_volume(const TriangleMesh& mesh, const Imath::Box3d& bounds)
{
    using Wide = Imath::Vec3<long double>;
    const V3d half = bounds.max * 0.5 - bounds.min * 0.5;
    const int exponent = std::ilogb(std::max({half.x, half.y, half.z}));
    const V3d middle = bounds.min * 0.5 + bounds.max * 0.5;
    const auto scaled = [&](uint32_t vertex) {
        const Wide d = Wide(mesh.positions[vertex]) - Wide(middle);
        return Wide(std::scalbn(d.x, -exponent), std::scalbn(d.y, -exponent), std::scalbn(d.z, -exponent));
    };
    long double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) sum += scaled(a).dot(scaled(b).cross(scaled(c)));
    return static_cast<double>(std::scalbn(sum / 6, 3 * exponent));
}

bool is_finite(const V3d& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

} // namespace

Domain::Domain(TriangleMesh mesh, std::string place) : impl_(std::make_unique<Impl>())
{
    Impl& d = *impl_;
    d.mesh = std::move(mesh);
    d.place = std::move(place);
    if (const auto defect = find_surface_defect(d.mesh)) d.fail(*defect);
    d.tree.emplace(d.mesh);
    if (const auto defect = describe_inside_out(d.mesh, find_inside_out_shells(d.mesh, find_shells(d.mesh), *d.tree)))
        d.fail(*defect);
    d.bounds = bounds_of(d.mesh);
    d.volume = enclosed_volume(d.mesh, d.bounds);
}

Domain::~Domain() = default;

const TriangleMesh& Domain::mesh() const { return impl_->mesh; }

const std::string& Domain::place() const { return impl_->place; }

const Imath::Box3d& Domain::bounds() const { return impl_->bounds; }

double Domain::volume() const { return impl_->volume; }

const SurfaceTree& Domain::surface() const { return *impl_->tree; }

bool Domain::contains(const V3d& point) const { return contains_sphere(point, 0); }

bool Domain::contains_sphere(const V3d& centre, double radius) const
{
    if (!is_finite(centre) || !(radius >= 0)) return false;
    const auto& [lo, hi] = impl_->bounds;
    // Rounding is monotone: where the rounded difference is beyond the bounds, so is the exact one.
    for (int k = 0; k < 3; ++k)
        if (centre[k] - radius < lo[k] || centre[k] + radius > hi[k]) return false;
    return !impl_->tree->reaches_into_ball(centre, radius) && impl_->tree->encloses(centre);
}

double Domain::distance(const V3d& point) const { return impl_->tree->distance(point); }

} // namespace scree
