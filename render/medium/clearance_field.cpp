#include "render/medium/clearance_field.h"

#include "ingest/support/error.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <limits>

namespace scree {

namespace {

constexpr double slack = 1e-9; ///< in cells: what rounding may do to coordinates up to 2048

/// Marks cells through which triangles pass, and a few that are next to such.
///
/// A part of a triangle beyond the box marks the cells that are nearest to it: the projection to a convex set brings no two points
/// farther apart, so the distance from a place in the box to the projection is not above that to the triangle.
class Marker {
public:
    Marker(const std::array<int, 3>& size, std::vector<std::atomic<uint8_t>>& marks) : size_(size), marks_(marks) {}

    /// Corners in cells from the box's lower corner.
    void mark(const V3d& a, const V3d& b, const V3d& c) const
    {
        int first[3], last[3];
        bool beyond = false;
        double away = 0; ///< from the box, along the axis where that is most
        for (int k = 0; k < 3; ++k) {
            const double lo = std::min({a[k], b[k], c[k]}) - slack, hi = std::max({a[k], b[k], c[k]}) + slack, end = size_[static_cast<size_t>(k)] - 1;
            first[k] = static_cast<int>(std::clamp(std::floor(lo), 0.0, end));
            last[k] = static_cast<int>(std::clamp(std::floor(hi), 0.0, end));
            beyond = beyond || lo < 0 || hi > end + 1;
            away = std::max({away, -hi, lo - end - 1});
        }
        // Far beyond the box pieces may be large, or a plain around it would be cut to as many as it has cells.
        if (std::max({last[0] - first[0], last[1] - first[1], last[2] - first[2]}) <= 1 + away / 4) {
            const V3d normal = (b - a).cross(c - a);
            for (int x = first[0]; x <= last[0]; ++x)
                for (int y = first[1]; y <= last[1]; ++y)
                    for (int z = first[2]; z <= last[2]; ++z)
                        if (beyond || meets_plane(V3d(x + 0.5, y + 0.5, z + 0.5) - a, normal)) set(x, y, z);
            return;
        }
        // The longest edge's middle: pieces shrink in all directions.
        const double ab = (b - a).length2(), bc = (c - b).length2(), ca = (a - c).length2();
        if (ab >= bc && ab >= ca) halve(a, b, c);
        else if (bc >= ca) halve(b, c, a);
        else halve(c, a, b);
    }

private:
    void halve(const V3d& a, const V3d& b, const V3d& c) const
    {
        const V3d middle = a * 0.5 + b * 0.5;
        mark(a, middle, c);
        mark(middle, b, c);
    }

    /// Whether a plane meets the cell around `centre` (from a point of the plane); a normal of no length: yes.
    static bool meets_plane(const V3d& centre, const V3d& normal)
    {
        const double width = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
        return std::abs(centre.dot(normal)) <= (0.5 + slack) * width;
    }

    void set(int x, int y, int z) const
    {
        const auto at = (static_cast<size_t>(x) * static_cast<size_t>(size_[1]) + static_cast<size_t>(y)) * static_cast<size_t>(size_[2]) + static_cast<size_t>(z);
        marks_[at].store(1, std::memory_order_relaxed);
    }

    std::array<int, 3> size_;
    std::vector<std::atomic<uint8_t>>& marks_;
};

/// Squares of distances along some axes, from the centres of voxels there and from cells (half a voxel) along the others.
struct Squares {
    std::array<size_t, 3> size{};
    std::vector<float> values;

    explicit Squares(const std::array<size_t, 3>& of) : size(of), values(of[0] * of[1] * of[2], std::numeric_limits<float>::infinity()) {}
    float* row(size_t x, size_t y) { return &values[(x * size[1] + y) * size[2]]; }
    const float* row(size_t x, size_t y) const { return &values[(x * size[1] + y) * size[2]]; }
};

/// From the centre of voxel i, between cells 2 i and 2 i + 1, to the near face of cell j; in cells.
size_t gap(size_t i, size_t j) { return j > 2 * i ? j - 2 * i - 1 : 2 * i - j; }

/// Along z, from the marked cells.
Squares from_marks(const std::vector<std::atomic<uint8_t>>& marks, const std::array<size_t, 3>& cells)
{
    Squares to({cells[0], cells[1], cells[2] / 2});
    tbb::parallel_for(size_t{0}, cells[0] * cells[1], [&](size_t line) {
        const std::atomic<uint8_t>* mark = &marks[line * cells[2]];
        float* row = &to.values[line * to.size[2]];
        const auto lower = [row](size_t i, size_t j) { row[i] = std::min(row[i], static_cast<float>(gap(i, j) * gap(i, j))); };
        const size_t none = cells[2];
        size_t nearest = none;
        for (size_t j = 0; j < cells[2]; ++j) {
            if (mark[j].load(std::memory_order_relaxed)) nearest = j;
            if (nearest != none && j % 2 == 0) lower(j / 2, nearest);
        }
        nearest = none;
        for (size_t j = cells[2]; j-- > 0;) {
            if (mark[j].load(std::memory_order_relaxed)) nearest = j;
            if (nearest != none && j % 2 == 1) lower(j / 2, nearest);
        }
    });
    return to;
}

/// to[i] becomes the least from[j] + gap(i, j)^2 along x or y; all of a row along z at once.
Squares along(size_t axis, const Squares& from, const Progress& progress)
{
    std::array<size_t, 3> size = from.size;
    size[axis] /= 2;
    Squares to(size);
    tbb::parallel_for(size_t{0}, size[0] * size[1], [&](size_t line) {
        if (progress.cancelled()) return;
        const size_t x = line / size[1], y = line % size[1], i = axis == 0 ? x : y;
        float* row = to.row(x, y);
        for (size_t j = 0; j < from.size[axis]; ++j) {
            const float* other = axis == 0 ? from.row(j, y) : from.row(x, j);
            const auto square = static_cast<float>(gap(i, j) * gap(i, j));
            for (size_t z = 0; z < size[2]; ++z) row[z] = std::min(row[z], other[z] + square);
        }
    });
    if (progress.cancelled()) throw Cancelled();
    return to;
}

} // namespace

ClearanceField::ClearanceField(std::span<const TriangleView> meshes, const Imath::Box3d& box, const Progress& progress, int voxels)
{
    if (voxels < 1 || voxels > 1024) throw InputError("clearance field", fmt::format("{} voxels", voxels), "1 to 1024");
    const V3d extent = box.size();
    const double longest = std::max({extent.x, extent.y, extent.z});
    if (box.isEmpty() || !(longest > 0) || !std::isfinite(longest)) throw InputError("clearance field", "a box that is empty or infinite", "a finite box");
    origin_ = box.min;
    voxel_ = longest / voxels;
    per_length_ = 1 / voxel_;
    for (int k = 0; k < 3; ++k) size_[static_cast<size_t>(k)] = std::clamp(static_cast<int>(std::ceil(extent[k] * per_length_)), 1, voxels);
    // Marked in cells of half the edge: what is lost by not knowing where in a cell a triangle is halves.
    const std::array<int, 3> cells{2 * size_[0], 2 * size_[1], 2 * size_[2]};
    const std::array<size_t, 3> count{static_cast<size_t>(cells[0]), static_cast<size_t>(cells[1]), static_cast<size_t>(cells[2])};
    std::vector<std::atomic<uint8_t>> marks(count[0] * count[1] * count[2]);
    const Marker marker(cells, marks);
    for (const TriangleView& mesh : meshes) {
        tbb::parallel_for(size_t{0}, mesh.triangles.size(), [&](size_t t) {
            if (progress.cancelled()) return;
            V3d corner[3];
            for (size_t k = 0; k < 3; ++k) {
                const uint32_t vertex = mesh.triangles[t][k];
                if (vertex >= mesh.positions.size()) throw InputError("clearance field", fmt::format("vertex {}", vertex), fmt::format("below {}", mesh.positions.size()));
                corner[k] = (V3d(mesh.positions[vertex]) - origin_) * (2 * per_length_);
                if (!std::isfinite(corner[k].x + corner[k].y + corner[k].z)) throw InputError("clearance field", fmt::format("vertex {} that is not finite", vertex), "finite numbers");
            }
            marker.mark(corner[0], corner[1], corner[2]);
        });
        if (progress.cancelled()) throw Cancelled();
    }

    // Squares of whole numbers: their sums are exact in float, up to 3 * 2048^2.
    distance_ = along(0, along(1, from_marks(marks, count), progress), progress).values;
    // Places are found in their voxels, and triangles in theirs, up to rounding.
    for (float& d : distance_) d = std::max(0.0f, 0.5f * std::sqrt(d) * (1 - 0x1p-22f) - 1e-6f);
    progress.update("clearance", 1);
}

} // namespace scree
