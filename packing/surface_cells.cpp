#include "packing/surface_cells.h"

#include "mixtures/hash.h"
#include "packing/exact_distance.h"
#include "packing/surface_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace scree {

using Imath::V3d;

namespace {

constexpr uint64_t slot_count = uint64_t{1} << 19;
constexpr uint64_t most_probes = 16;
constexpr uint64_t most_bytes = uint64_t{96} << 20;
constexpr size_t most_triangles = 64; // of a cell: where more are near, the tree is faster than the list
constexpr int axis_bits = 20;         // of a cell's number along an axis
constexpr size_t lanes = 8;

double largest_component(const V3d& v)
{
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

using Lanes = std::array<float, lanes>;

/// Triangles in short; lengths are scaled, places from the cell's middle.
struct Triangles {
    /// Their planes, with unit normals n pointing out of the solid: a place q is n.q - offset above one. A triangle whose
    /// plane is not known well has a zero normal and offset.
    Lanes x, y, z, offset;
    /// Balls around them; infinite ones around large triangles.
    Lanes middle_x, middle_y, middle_z, radius;
    std::array<uint32_t, lanes> face;

    Lanes heights(float qx, float qy, float qz) const
    {
        Lanes h;
        for (size_t k = 0; k < lanes; ++k) h[k] = x[k] * qx + y[k] * qy + z[k] * qz - offset[k];
        return h;
    }
    /// How far the triangles are at least, by their balls.
    Lanes clearance(float qx, float qy, float qz) const
    {
        Lanes d;
        for (size_t k = 0; k < lanes; ++k) {
            const float dx = qx - middle_x[k], dy = qy - middle_y[k], dz = qz - middle_z[k];
            d[k] = std::sqrt(dx * dx + dy * dy + dz * dz) - radius[k];
        }
        return d;
    }
};

} // namespace

struct SurfaceCells::Cell {
    enum class Kind : uint8_t { outside, inside, near, crowded };
    uint64_t key = 0;
    Kind kind = Kind::crowded;
    std::vector<Triangles> triangles; // all that may be the nearest to a place in the cell, or within the largest radius of it; the last repeats
};

SurfaceCells::SurfaceCells(const Domain& domain, double largest) : domain_(domain), largest_(largest)
{
    const V3d size = domain.bounds().size();
    const double longest = std::max({size.x, size.y, size.z});
    const auto faces = static_cast<double>(domain.mesh().triangles.size());
    // About as large as the triangles are, so that few are near; and larger than the balls.
    const double edge = std::max(longest / std::max(64.0, std::sqrt(faces)), 4 * largest);
    // Beyond what follows is written for, there are no cells.
    if (!(largest > 0) || !(longest > 0x1p-900) || !(longest < 0x1p900) || !(edge < longest) || !(longest / edge < (1 << axis_bits) - 2)) return;
    scale_ = std::ldexp(1.0, -std::ilogb(longest) - 1);
    edge_ = edge;
    const double farthest = std::max(largest_component(domain.bounds().min), largest_component(domain.bounds().max));
    half_ = std::sqrt(0.75) * edge_ * (1 + 0x1p-20) + 0x1p-48 * farthest;
    // See `make`.
    error_ = static_cast<float>(half_ * scale_ * 0x1p-18);
    slots_ = std::make_unique<std::atomic<const Cell*>[]>(slot_count);
    bytes_ = slot_count * sizeof(slots_[0]);
}

SurfaceCells::~SurfaceCells()
{
    if (!slots_) return;
    for (uint64_t k = 0; k < slot_count; ++k) delete slots_[k].load();
}

uint64_t SurfaceCells::bytes() const
{
    return bytes_.load();
}

V3d SurfaceCells::middle(uint64_t key) const
{
    constexpr uint64_t mask = (uint64_t{1} << axis_bits) - 1;
    const V3d index(static_cast<double>(key & mask), static_cast<double>(key >> axis_bits & mask), static_cast<double>(key >> 2 * axis_bits));
    return domain_.bounds().min + (index + V3d(0.5)) * edge_;
}

const SurfaceCells::Cell* SurfaceCells::find(uint64_t key) const
{
    uint64_t slot = mix64(key) % slot_count;
    for (uint64_t probe = 0; probe < most_probes; ++probe, slot = (slot + 1) % slot_count) {
        const Cell* cell = slots_[slot].load(std::memory_order_acquire);
        if (!cell) {
            if (bytes_.load(std::memory_order_relaxed) > most_bytes) return nullptr;
            std::unique_ptr<Cell> made = make(key);
            const uint64_t size = sizeof(Cell) + made->triangles.capacity() * sizeof(Triangles);
            if (slots_[slot].compare_exchange_strong(cell, made.get(), std::memory_order_acq_rel)) {
                bytes_.fetch_add(size, std::memory_order_relaxed);
                return made.release();
            }
            // Another thread was first, perhaps with the same cell.
        }
        if (cell->key == key) return cell;
    }
    return nullptr;
}

std::unique_ptr<SurfaceCells::Cell> SurfaceCells::make(uint64_t key) const
{
    auto cell = std::make_unique<Cell>();
    cell->key = key;
    const V3d m = middle(key);
    const SurfaceTree& surface = domain_.surface();
    const TriangleMesh& mesh = domain_.mesh();
    const auto corners = [&](uint32_t face) {
        const auto& t = mesh.triangles[face];
        return Corners{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    };

    // A triangle that matters is within half + largest of the middle, or the nearest of one such is within half of it.
    static thread_local std::vector<uint32_t> faces;
    static thread_local std::vector<DistanceBounds> bounds;
    faces.clear();
    bounds.clear();
    surface.collect_near(m, (3 * half_ + largest_) * (1 + 0x1p-40), faces);
    DistanceBounds nearest{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (const uint32_t face : faces) {
        bounds.push_back(bound_distance(m, corners(face), scale_));
        nearest.lo = std::min(nearest.lo, bounds.back().lo);
        nearest.hi = std::min(nearest.hi, bounds.back().hi);
    }
    const double half = half_ * scale_, largest = largest_ * scale_;
    if (nearest.lo > (half + largest) * (1 + 0x1p-40)) {
        cell->kind = surface.encloses(m) ? Cell::Kind::inside : Cell::Kind::outside;
        return cell;
    }
    const double reach = std::max(nearest.hi + 2 * half, half + largest) * (1 + 0x1p-40);
    size_t count = 0;
    for (size_t k = 0; k < faces.size(); ++k) {
        if (bounds[k].lo <= reach) faces[count++] = faces[k];
    }
    if (count > most_triangles) return cell;

    // Let u = 2^-24 and H be half; largest < 0.3 H, so reach < 3.4 H, offset < 3.4 H, and |q| <= H. Heights are off by u H each for the
    // rounding of normal and q, 3 u H for that of the product, 4.4 u H for the difference, 3.4 u H for the offset's
    // rounding, and 3 u H at most for the normal's own error: below 16 u H. Clearances: 14 u H for the rounding of q, middle
    // and their difference, which is below 7 H, 18 u H for square and root, 13 u H for the radius and the last
    // difference: below 46 u H. `error_` is 64 u H.
    const double unit = 0x1p-24;
    cell->kind = Cell::Kind::near;
    cell->triangles.resize((count + lanes - 1) / lanes);
    for (size_t k = 0; k < cell->triangles.size() * lanes; ++k) {
        const uint32_t face = faces[std::min(k, count - 1)];
        const Corners c = corners(face);
        const V3d a = (c[0] - m) * scale_, b = (c[1] - m) * scale_, d = (c[2] - m) * scale_;
        const V3d ab = b - a, ad = d - a, cross = ab.cross(ad);
        const double length = cross.length(), span = std::max(ab.length(), ad.length());
        const double farthest = std::max({largest_component(a), largest_component(b), largest_component(d), span});
        // Edges are off by 4 * 2^-53 of the farthest in length, so the cross product by less than 16 * 2^-53 farthest span; what is
        // said of the offset rests on a corner, 4 * 2^-53 farthest and the normal's error times its distance off.
        Triangles& packed = cell->triangles[k / lanes];
        const size_t lane = k % lanes;
        packed.face[lane] = face;
        const double turn = 16 * 0x1p-53 * farthest * span / length;
        const bool known = length > 0x1p-900 && turn <= unit / 4 && (turn + 16 * 0x1p-53) * farthest * 2 <= unit * half;
        const V3d n = known ? cross / length : V3d(0);
        packed.x[lane] = static_cast<float>(n.x);
        packed.y[lane] = static_cast<float>(n.y);
        packed.z[lane] = static_cast<float>(n.z);
        packed.offset[lane] = known ? static_cast<float>(n.dot(a)) : 0;
        const V3d middle = (a + b + d) / 3;
        const double radius = std::max({(a - middle).length(), (b - middle).length(), (d - middle).length()});
        const bool is_small = middle.length() + radius < 6 * half;
        packed.middle_x[lane] = is_small ? static_cast<float>(middle.x) : 0;
        packed.middle_y[lane] = is_small ? static_cast<float>(middle.y) : 0;
        packed.middle_z[lane] = is_small ? static_cast<float>(middle.z) : 0;
        packed.radius[lane] = is_small ? static_cast<float>(radius) : std::numeric_limits<float>::infinity();
    }
    return cell;
}

bool SurfaceCells::contains_sphere(const V3d& centre, double radius) const
{
    const Imath::Box3d& bounds = domain_.bounds();
    for (int k = 0; k < 3; ++k)
        if (!(centre[k] - radius >= bounds.min[k]) || !(centre[k] + radius <= bounds.max[k])) return false;
    if (edge_ > 0 && radius > 0 && radius <= largest_) {
        const V3d index = (centre - bounds.min) / edge_;
        const auto along = [&](int k) { return static_cast<uint64_t>(index[k]); };
        const uint64_t key = along(0) | along(1) << axis_bits | along(2) << 2 * axis_bits;
        if (const Cell* cell = find(key)) {
            if (cell->kind == Cell::Kind::inside || cell->kind == Cell::Kind::outside) return cell->kind == Cell::Kind::inside;
            if (cell->kind == Cell::Kind::near) {
                const Answer answer = ask(*cell, (centre - middle(key)) * scale_, centre, radius);
                if (answer != Answer::unknown) return answer == Answer::yes;
            }
        }
    }
    domain_tests_.fetch_add(1, std::memory_order_relaxed);
    return domain_.contains_sphere(centre, radius);
}

SurfaceCells::Answer SurfaceCells::ask(const Cell& cell, const V3d& offset, const V3d& centre, double radius) const
{
    const auto qx = static_cast<float>(offset.x), qy = static_cast<float>(offset.y), qz = static_cast<float>(offset.z);
    Lanes lows, highs;
    lows.fill(std::numeric_limits<float>::infinity());
    highs.fill(-std::numeric_limits<float>::infinity());
    std::array<float, most_triangles> height, least;
    for (size_t g = 0; g < cell.triangles.size(); ++g) {
        const Lanes h = cell.triangles[g].heights(qx, qy, qz), d = cell.triangles[g].clearance(qx, qy, qz);
        for (size_t k = 0; k < lanes; ++k) {
            lows[k] = h[k] < lows[k] ? h[k] : lows[k];
            highs[k] = h[k] > highs[k] ? h[k] : highs[k];
            const float away = std::abs(h[k]);
            height[g * lanes + k] = h[k];
            least[g * lanes + k] = (d[k] > away ? d[k] : away) - error_;
        }
    }
    float lowest = lows[0], highest = highs[0];
    for (size_t k = 1; k < lanes; ++k) {
        lowest = std::min(lowest, lows[k]);
        highest = std::max(highest, highs[k]);
    }
    // The triangles that meet where the surface is nearest are among these. Where the centre is behind all of them it is inside, and
    // where it is before all of them outside: an average of their normals tells (Baerentzen and Aanaes 2005). And no
    // triangle is nearer than its plane.
    if (lowest > error_) return Answer::no;
    const double r = radius * scale_;
    if (-double{highest} >= r + error_) return Answer::yes;

    const size_t count = cell.triangles.size() * lanes;
    const TriangleMesh& mesh = domain_.mesh();
    double nearest = std::numeric_limits<double>::infinity();
    const auto look_at = [&](size_t k) {
        const auto& t = mesh.triangles[cell.triangles[k / lanes].face[k % lanes]];
        return bound_distance(centre, {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}, scale_);
    };
    // The likely nearest first: with its distance known, most others need not be looked at.
    const auto first = static_cast<size_t>(std::min_element(least.begin(), least.begin() + static_cast<std::ptrdiff_t>(count)) - least.begin());
    bool before = false, behind = false;
    for (size_t i = 0; i <= count; ++i) {
        const size_t k = i == 0 ? first : i - 1;
        if (least[k] >= r && least[k] > nearest) continue;
        if (i == 0 || k != first) {
            const DistanceBounds d = look_at(k);
            if (d.hi < r) return Answer::no;
            if (d.lo < r) return Answer::unknown;
            nearest = std::min(nearest, d.hi);
            if (d.lo > nearest) continue;
        }
        // It may be the nearest.
        before = before || !(height[k] < -error_);
        behind = behind || !(height[k] > error_);
    }
    if (before && behind) return Answer::unknown;
    return behind ? Answer::yes : Answer::no;
}

} // namespace scree
