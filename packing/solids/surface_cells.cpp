#include "packing/solids/surface_cells.h"

#include "base/hash.h"
#include "packing/solids/exact_distance.h"
#include "packing/solids/surface_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace scree {

using Imath::V3d;
using Imath::V3f;

namespace {

constexpr uint64_t slot_count = uint64_t{1} << 19;
constexpr uint64_t most_probes = 16;
constexpr uint64_t most_bytes = uint64_t{96} << 20; // of all cells
constexpr size_t most_triangles = 128; // of a cell: beyond, the tree is faster than the list
constexpr int axis_bits = 20; // bits of a cell's number along an axis
constexpr size_t lanes = 8;

double largest_component(const V3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

using Lanes = std::array<float, lanes>;

/// The planes of triangles, scaled, with unit normals n that point out of the solid. A place q, relative to the cell's
/// middle, is n.q - offset above a plane. A triangle without an accurate plane has normal and offset zero.
struct Planes {
    Lanes x, y, z, offset;
    std::array<uint32_t, lanes> face;

    Lanes heights(float qx, float qy, float qz) const
    {
        Lanes h;
        for (size_t k = 0; k < lanes; ++k) h[k] = x[k] * qx + y[k] * qy + z[k] * qz - offset[k];
        return h;
    }
};

} // namespace

/// A triangle's plane, and a bound on how far a place lies beyond the triangle's edges.
struct SurfaceCells::Plate {
    V3d middle, normal; ///< scene units; unit normal out of the solid, zero if it is not accurate
    std::array<V3f, 3> side; ///< nearly unit vectors
    std::array<float, 3> reach{}; ///< scaled: greatest extent of the triangle from its middle along each side's vector

    Plate(const Corners& corners, double scale, double half) : middle(corners[0] / 3 + corners[1] / 3 + corners[2] / 3)
    {
        std::array<V3d, 3> c;
        for (size_t k = 0; k < 3; ++k) c[k] = (corners[k] - middle) * scale;
        const V3d ab = (corners[1] - corners[0]) * scale, ac = (corners[2] - corners[0]) * scale, cross = ab.cross(ac);
        const double length = cross.length(), radius = std::max({c[0].length(), c[1].length(), c[2].length()});
        // Each component of the cross product is off by less than 4 * 2^-53 of the edges' product, which turns the
        // normal by no more than this.
        const double turn = 8 * 0x1p-53 * ab.length() * ac.length() / length;
        normal = length > 0x1p-900 && turn * (8 * half + radius) <= 0x1p-26 * half ? cross / length : V3d(0);
        for (size_t k = 0; k < 3; ++k) {
            // True for any vector, however it is rounded: the triangle reaches no farther along it.
            side[k] = V3f((c[(k + 1) % 3] - c[k]).cross(normal).normalized());
            const V3d s(side[k]);
            reach[k] = static_cast<float>(std::max({s.dot(c[0]), s.dot(c[1]), s.dot(c[2])}));
        }
    }

    /// A lower bound, from the edges, on the distance of a place given relative to the middle; scaled.
    double beyond(const V3d& place) const
    {
        const V3f q(place);
        const float most = std::max({side[0].dot(q) - reach[0], side[1].dot(q) - reach[1], side[2].dot(q) - reach[2]});
        // Let u = 2^-24: the vectors' lengths, q, the product and the difference are off by less than 8 u of |q| in
        // all, because reach is below |q| wherever the result is positive.
        return most - 0x1p-19 * (std::abs(place.x) + std::abs(place.y) + std::abs(place.z));
    }
};

struct SurfaceCells::Cell {
    enum class Kind : uint8_t { outside, inside, near, crowded };
    uint64_t key = 0;
    Kind kind = Kind::crowded;
    uint32_t count = 0;
    std::vector<Planes> planes; // of all triangles that may be nearest to a place in the cell, or within the largest
                                // radius of one; the last is repeated to fill the lanes
};

SurfaceCells::SurfaceCells(const Domain& domain, double largest) : domain_(domain), largest_(largest)
{
    const V3d size = domain.bounds().size();
    const double longest = std::max({size.x, size.y, size.z});
    const auto faces = static_cast<double>(domain.mesh().triangles.size());
    // Cells are about as large as the triangles, so that few are near, and larger than the balls.
    const double edge = std::max(longest / std::max(64.0, std::sqrt(faces)), 4 * largest);
    // Outside the range for which the error bounds hold, no cells are used.
    const double farthest = std::max(largest_component(domain.bounds().min), largest_component(domain.bounds().max));
    if (!(largest > 0) || !(longest > 0x1p-900) || !(longest < 0x1p900) || !(edge < longest) ||
        !(longest / edge < (1 << axis_bits) - 2) || !(farthest < 0x1p20 * edge))
        return;
    scale_ = std::ldexp(1.0, -std::ilogb(longest) - 1);
    edge_ = edge;
    half_ = std::sqrt(0.75) * edge_ * (1 + 0x1p-20);
    // `make` derives this bound.
    error_ = static_cast<float>(half_ * scale_ * 0x1p-18);
    slots_ = std::make_unique<std::atomic<const Cell*>[]>(slot_count);
    plates_.reserve(domain.mesh().triangles.size());
    for (uint32_t face = 0; face < domain.mesh().triangles.size(); ++face)
        plates_.emplace_back(corners(face), scale_, half_ * scale_);
    bytes_ = slot_count * sizeof(slots_[0]) + plates_.size() * sizeof(Plate);
}

SurfaceCells::~SurfaceCells()
{
    if (!slots_) return;
    for (uint64_t k = 0; k < slot_count; ++k) delete slots_[k].load();
}

uint64_t SurfaceCells::bytes() const { return bytes_.load(); }

V3d SurfaceCells::middle(uint64_t key) const
{
    constexpr uint64_t mask = (uint64_t{1} << axis_bits) - 1;
    const V3d index(static_cast<double>(key & mask), static_cast<double>(key >> axis_bits & mask),
                    static_cast<double>(key >> 2 * axis_bits));
    return domain_.bounds().min + (index + V3d(0.5)) * edge_;
}

Corners SurfaceCells::corners(uint32_t face) const
{
    const TriangleMesh& mesh = domain_.mesh();
    const auto& [a, b, c] = mesh.triangles[face];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

const SurfaceCells::Cell* SurfaceCells::find(uint64_t key) const
{
    uint64_t slot = mix64(key) % slot_count;
    for (uint64_t probe = 0; probe < most_probes; ++probe, slot = (slot + 1) % slot_count) {
        const Cell* cell = slots_[slot].load(std::memory_order_acquire);
        if (!cell) {
            if (bytes_.load(std::memory_order_relaxed) > most_bytes + plates_.size() * sizeof(Plate)) return nullptr;
            std::unique_ptr<Cell> made = make(key);
            const uint64_t size = sizeof(Cell) + made->planes.capacity() * sizeof(Planes);
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
    const double half = half_ * scale_;
    // A triangle that matters is within half + largest of the middle, or at most 2 half farther than the nearest one,
    // which is within half + largest.
    std::vector<uint32_t> faces;
    domain_.surface().collect_near(m, (3 * half_ + largest_) * (1 + 0x1p-40), faces);

    // Let u = 2^-24 and H be half; largest < 0.3 H, so all are within 3.4 H, and |q| <= H. Places are off by less than
    // 2^-4 u H, as the bounds are within 2^20 edges of the origin. Heights are off by u H each for the rounding of
    // normal and q, 3 u H for that of the product, 4.4 u H for the difference, 3.4 u H for the offset's rounding, and u
    // H for the normal's own error: below 15 u H. `error_` is 64 u H.
    std::vector<double> least(faces.size());
    double lowest = std::numeric_limits<double>::infinity();
    size_t first = 0;
    for (size_t k = 0; k < faces.size(); ++k) {
        const Plate& plate = plates_[faces[k]];
        least[k] = lower_bound(plate, m, std::abs((plate.middle - m).dot(plate.normal)) * scale_ - error_);
        if (least[k] >= lowest) continue;
        lowest = least[k];
        first = k;
    }
    if (lowest > half + largest_ * scale_) {
        cell->kind = domain_.surface().encloses(m) ? Cell::Kind::inside : Cell::Kind::outside;
        return cell;
    }
    const double nearest = bound_distance(m, corners(faces[first]), scale_).hi;
    const double reach = std::max(nearest + 2 * half, half + largest_ * scale_) * (1 + 0x1p-40);
    size_t count = 0;
    for (size_t k = 0; k < faces.size(); ++k) {
        if (least[k] <= reach) faces[count++] = faces[k];
    }
    if (count > most_triangles) return cell;

    cell->kind = Cell::Kind::near;
    cell->count = static_cast<uint32_t>(count);
    cell->planes.resize((count + lanes - 1) / lanes);
    for (size_t k = 0; k < cell->planes.size() * lanes; ++k) {
        Planes& planes = cell->planes[k / lanes];
        const size_t lane = k % lanes;
        const uint32_t face = faces[std::min(k, count - 1)];
        const V3d n = plates_[face].normal;
        planes.x[lane] = static_cast<float>(n.x);
        planes.y[lane] = static_cast<float>(n.y);
        planes.z[lane] = static_cast<float>(n.z);
        planes.offset[lane] = static_cast<float>(n.dot(plates_[face].middle - m) * scale_);
        planes.face[lane] = face;
    }
    return cell;
}

double SurfaceCells::lower_bound(const Plate& plate, const V3d& place, double least) const
{
    // error_ is far above the rounding of places.
    return std::max(least, plate.beyond((place - plate.middle) * scale_) - error_);
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
            if (cell->kind == Cell::Kind::inside || cell->kind == Cell::Kind::outside)
                return cell->kind == Cell::Kind::inside;
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
    std::array<float, most_triangles> height;
    for (size_t g = 0; g < cell.planes.size(); ++g) {
        const Lanes h = cell.planes[g].heights(qx, qy, qz);
        for (size_t k = 0; k < lanes; ++k) {
            lows[k] = h[k] < lows[k] ? h[k] : lows[k];
            highs[k] = h[k] > highs[k] ? h[k] : highs[k];
            height[g * lanes + k] = h[k];
        }
    }
    const float lowest = *std::min_element(lows.begin(), lows.end()),
                highest = *std::max_element(highs.begin(), highs.end());
    // The triangles that meet at the surface's nearest point are among these. If the centre is behind all of them, it
    // is inside; if it is in front of all of them, it is outside, because an average of their normals decides
    // (Baerentzen and Aanaes 2005). No triangle is nearer than its plane.
    if (lowest > error_) return Answer::no;
    const double r = radius * scale_;
    if (-double{highest} >= r + error_) return Answer::yes;

    // Test triangles one by one with increasingly tight bounds, the likely nearest first.
    const auto face = [&](size_t k) { return cell.planes[k / lanes].face[k % lanes]; };
    std::array<double, most_triangles> least;
    std::array<bool, most_triangles> by_edges;
    size_t first = 0;
    for (size_t k = 0; k < cell.count; ++k) {
        least[k] = std::abs(double{height[k]}) - error_;
        by_edges[k] = least[k] < r;
        if (by_edges[k]) least[k] = lower_bound(plates_[face(k)], centre, least[k]);
        if (least[k] < least[first]) first = k;
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i <= cell.count; ++i) {
        const size_t k = i == 0 ? first : i - 1;
        if (i > 0) {
            if (k == first || least[k] > nearest) continue;
            if (!by_edges[k]) least[k] = lower_bound(plates_[face(k)], centre, least[k]);
            if (least[k] > nearest) continue;
        }
        const DistanceBounds d = bound_distance(centre, corners(face(k)), scale_);
        if (d.hi < r) return Answer::no;
        if (d.lo < r) return Answer::unknown;
        least[k] = d.lo;
        nearest = std::min(nearest, d.hi);
    }
    // The ball is clear of all triangles. Those that may be nearest decide the side.
    bool before = false, behind = false;
    for (size_t k = 0; k < cell.count; ++k) {
        if (least[k] > nearest) continue;
        before = before || !(height[k] < -error_);
        behind = behind || !(height[k] > error_);
    }
    if (before && behind) return Answer::unknown;
    return behind ? Answer::yes : Answer::no;
}

} // namespace scree
