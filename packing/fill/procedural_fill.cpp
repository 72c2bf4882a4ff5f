#include "packing/fill/procedural_fill.h"

#include "base/error.h"
#include "base/hash.h"

#include <Imath/ImathQuat.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {

namespace {

constexpr uint64_t kinds_kept = uint64_t{1} << 24;
// Voxels along the domain's longest side. Light that returns from a fill was seldom deeper than some ten spheres. If
// the spheres are much smaller than a voxel, the field only classifies cells; otherwise this many voxels decide most of
// the other questions.
constexpr int field_cells = 96;
constexpr uint64_t variant_stream = 0x74696c6573ull; // "tiles"

/// Found by random search: the lattice vectors up to 9.5 cells long stay 0.1748 of a cell away from the lines through 0
/// along the axes and the face and space diagonals of the scene.
Imath::M33d generic_rotation()
{
    const Imath::Quatd q = Imath::Quatd(0.8753, 0.4274, 0.1632, 0.1565).normalized();
    return q.toMatrix33();
}

/// The point rounded to multiples of the power of two `step`; `inverse`: 1 / step.
Imath::V3d snap(const Imath::V3d& p, double step, double inverse)
{
    const auto one = [=](double x) { return std::nearbyint(x * inverse) * step; };
    return {one(p.x), one(p.y), one(p.z)};
}

} // namespace

ProceduralFill::ProceduralFill(std::shared_ptr<const Domain> domain, std::shared_ptr<const PackingTile> tile,
                               const FillOptions& options)
    : domain_(std::move(domain)), tile_(std::move(tile)), field_(*domain_, field_cells),
      near_surface_(*domain_, tile_->largest_radius() * (options.radius / tile_->mean_radius()) * (1 + 0x1p-20))
{
    const Imath::Box3d& bounds = domain_->bounds();
    origin_ = 0.5 * bounds.min + 0.5 * bounds.max;
    scale_ = options.radius / tile_->mean_radius();
    int exponent = 0;
    std::frexp(2 * options.radius, &exponent);
    voxel_ = std::ldexp(1, exponent);
    step_ = std::ldexp(1, exponent - 24);
    inverse_step_ = std::ldexp(1, 24 - exponent);
    largest_radius_ = tile_->largest_radius() * scale_;
    rotation_ = generic_rotation();
    from_lattice_ = rotation_ * scale_;
    to_lattice_ = rotation_.transposed() * (1 / scale_);
    key_ = hash_key(options.seed, variant_stream);

    // The centres of the fill's spheres lie in the bounds, so the cells must cover the bounds' corners in the lattice.
    Imath::V3d lo(std::numeric_limits<double>::infinity()), hi(-lo);
    for (int corner = 0; corner < 8; ++corner) {
        const Imath::V3d p =
            to_lattice(Imath::V3d(corner & 1 ? bounds.max.x : bounds.min.x, corner & 2 ? bounds.max.y : bounds.min.y,
                                  corner & 4 ? bounds.max.z : bounds.min.z) -
                       origin_);
        for (int axis = 0; axis < 3; ++axis) {
            lo[axis] = std::min(lo[axis], p[axis] / tile_->size[axis]);
            hi[axis] = std::max(hi[axis], p[axis] / tile_->size[axis]);
        }
    }
    double cells = 1;
    for (int axis = 0; axis < 3; ++axis) cells *= std::floor(hi[axis]) - std::floor(lo[axis]) + 3;
    const double ids = cells * static_cast<double>(tile_->rows());
    const double widest = std::max({std::abs(hi.x - lo.x), std::abs(hi.y - lo.y), std::abs(hi.z - lo.z)});
    if (!(ids < 0x1p62) || !(widest < 0x1p30)) {
        throw InputError(domain_->place(),
                         fmt::format("a radius of {} in bounds of {} x {} x {}", options.radius, bounds.size().x,
                                     bounds.size().y, bounds.size().z),
                         "a radius that makes fewer than 2^62 spheres", "is the radius in the unit of the mesh?");
    }
    for (size_t axis = 0; axis < 3; ++axis) { // one more cell on each side, because of rounding
        const int k = static_cast<int>(axis);
        first_[axis] = static_cast<int64_t>(std::floor(lo[k])) - 1;
        count_[axis] = static_cast<uint64_t>(static_cast<int64_t>(std::floor(hi[k])) + 2 - first_[axis]);
    }
    if (cell_count() <= kinds_kept) kinds_ = std::make_unique<std::atomic<uint8_t>[]>(cell_count());
}

FillCell ProceduralFill::cell_at(const Imath::V3d& lattice) const
{
    const auto along = [&](int axis) { return static_cast<int64_t>(std::floor(lattice[axis] / tile_->size[axis])); };
    return {along(0), along(1), along(2)};
}

bool ProceduralFill::has(const FillCell& cell) const
{
    // Unsigned arithmetic turns a cell before the first one into a number far beyond the last one.
    return static_cast<uint64_t>(cell.x - first_[0]) < count_[0] &&
           static_cast<uint64_t>(cell.y - first_[1]) < count_[1] &&
           static_cast<uint64_t>(cell.z - first_[2]) < count_[2];
}

uint64_t ProceduralFill::number(const FillCell& cell) const
{
    return (static_cast<uint64_t>(cell.z - first_[2]) * count_[1] + static_cast<uint64_t>(cell.y - first_[1])) *
               count_[0] +
           static_cast<uint64_t>(cell.x - first_[0]);
}

FillCell ProceduralFill::cell(uint64_t number) const
{
    const uint64_t x = number % count_[0], rest = number / count_[0];
    return {first_[0] + static_cast<int64_t>(x), first_[1] + static_cast<int64_t>(rest % count_[1]),
            first_[2] + static_cast<int64_t>(rest / count_[1])};
}

uint32_t ProceduralFill::variant(uint64_t cell_number) const
{
    const uint64_t variants = tile_->variants.size();
    if (variants == 1) return 0;
    // Multiplies instead of dividing: the hash's upper half, as a fraction, times the number of variants.
    return static_cast<uint32_t>((hash_with_key(cell_number, key_) >> 32) * variants >> 32);
}

ProceduralFill::Sphere ProceduralFill::sphere(uint64_t id) const
{
    const uint64_t cell_number = id / tile_->rows();
    return sphere(cell(cell_number), variant(cell_number), id % tile_->rows());
}

ProceduralFill::Sphere ProceduralFill::sphere(const FillCell& c, uint32_t variant, uint64_t row) const
{
    const Imath::V3d corner(static_cast<double>(c.x) * tile_->size.x, static_cast<double>(c.y) * tile_->size.y,
                            static_cast<double>(c.z) * tile_->size.z);
    const Imath::V3d place = from_lattice(corner + tile_->variants[variant][row]);
    return {origin_ + snap(place, step_, inverse_step_), radius(row)};
}

ProceduralFill::CellKind ProceduralFill::kind(uint64_t cell_number) const
{
    if (kinds_) {
        const auto known = static_cast<CellKind>(kinds_[cell_number].load(std::memory_order_relaxed));
        if (known != CellKind::unknown) return known;
    }
    const FillCell c = cell(cell_number);
    const Imath::V3d middle((static_cast<double>(c.x) + 0.5) * tile_->size.x,
                            (static_cast<double>(c.y) + 0.5) * tile_->size.y,
                            (static_cast<double>(c.z) + 0.5) * tile_->size.z);
    const DistanceField::Interval distance = field_.signed_distance(origin_ + from_lattice(middle));
    // Every centre is within half the cell's diagonal of the cell's middle, except for rounding far below 2^-20.
    const double reach = 0.5 * tile_->size.length() * scale_ * (1 + 0x1p-20);
    CellKind kind = CellKind::boundary;
    if (distance.lo - reach >= largest_radius_ * (1 + 0x1p-20))
        kind = CellKind::inside;
    else if (distance.hi + reach < 0)
        kind = CellKind::outside;
    if (kinds_) kinds_[cell_number].store(static_cast<uint8_t>(kind), std::memory_order_relaxed);
    return kind;
}

bool ProceduralFill::is_whole(uint64_t cell_number, uint64_t row) const
{
    const CellKind cell_kind = kind(cell_number);
    if (cell_kind != CellKind::boundary) return cell_kind == CellKind::inside;
    return decide(sphere(id(cell_number, row)));
}

bool ProceduralFill::is_whole(uint64_t cell_number, uint64_t, const Sphere& sphere) const
{
    const CellKind cell_kind = kind(cell_number);
    return cell_kind == CellKind::boundary ? decide(sphere) : cell_kind == CellKind::inside;
}

bool ProceduralFill::decide(const Sphere& sphere) const
{
    return near_surface_.contains_sphere(sphere.centre, sphere.radius);
}

double ProceduralFill::expected_count() const
{
    return domain_->volume() / (tile_->size.x * tile_->size.y * tile_->size.z * scale_ * scale_ * scale_) *
           static_cast<double>(tile_->rows());
}

uint64_t ProceduralFill::bytes() const
{
    uint64_t places = 0;
    for (const auto& variant : tile_->variants) places += variant.size() * sizeof(Imath::V3d);
    return places + tile_->rows() * (sizeof(float) + sizeof(int32_t)) + field_.bytes() + near_surface_.bytes() +
           (kinds_ ? cell_count() : 0);
}

} // namespace scree
