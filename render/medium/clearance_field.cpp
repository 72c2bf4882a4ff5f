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
        bool small = true, beyond = false;
        for (int k = 0; k < 3; ++k) {
            const double lo = std::min({a[k], b[k], c[k]}) - slack, hi = std::max({a[k], b[k], c[k]}) + slack, end = size_[static_cast<size_t>(k)] - 1;
            first[k] = static_cast<int>(std::clamp(std::floor(lo), 0.0, end));
            last[k] = static_cast<int>(std::clamp(std::floor(hi), 0.0, end));
            small = small && last[k] - first[k] <= 1;
            beyond = beyond || lo < 0 || hi > end + 1;
        }
        if (small) {
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

/// Squares of distances along some axes, from the centre of a voxel there and from a cell (half a voxel) along the others.
struct Squares {
    std::array<size_t, 3> size{};
    std::vector<float> values;

    size_t offset(const std::array<size_t, 3>& at) const { return (at[0] * size[1] + at[1]) * size[2] + at[2]; }
    size_t stride(size_t axis) const { return axis == 0 ? size[1] * size[2] : axis == 1 ? size[2] : 1; }
};

/// to[i] becomes the least from[j] + (distance from the centre of voxel i, which is between cells 2 i and 2 i + 1, to cell j)^2.
void transform_line(const float* from, size_t stride, size_t voxels, float* to, size_t to_stride)
{
    for (size_t i = 0; i < voxels; ++i) {
        float least = std::numeric_limits<float>::infinity();
        for (size_t gap = 0; gap < 2 * voxels; ++gap) {
            const auto square = static_cast<float>(gap * gap);
            const bool below = gap <= 2 * i, above = 2 * i + 1 + gap < 2 * voxels;
            if (square >= least || (!below && !above)) break;
            if (below) least = std::min(least, from[(2 * i - gap) * stride] + square);
            if (above) least = std::min(least, from[(2 * i + 1 + gap) * stride] + square);
        }
        to[i * to_stride] = least;
    }
}

Squares transform_axis(const Squares& from, size_t axis, const Progress& progress)
{
    Squares to;
    to.size = from.size;
    to.size[axis] /= 2;
    to.values.resize(to.size[0] * to.size[1] * to.size[2]);
    const size_t a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    tbb::parallel_for(size_t{0}, to.size[a], [&](size_t i) {
        std::array<size_t, 3> at{};
        at[a] = i;
        for (at[b] = 0; at[b] < to.size[b] && !progress.cancelled(); ++at[b])
            transform_line(&from.values[from.offset(at)], from.stride(axis), to.size[axis], &to.values[to.offset(at)], to.stride(axis));
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
    Squares squares;
    for (size_t k = 0; k < 3; ++k) squares.size[k] = static_cast<size_t>(cells[k]);
    std::vector<std::atomic<uint8_t>> marks(squares.size[0] * squares.size[1] * squares.size[2]);
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
    squares.values.resize(marks.size());
    for (size_t i = 0; i < marks.size(); ++i) squares.values[i] = marks[i] ? 0 : std::numeric_limits<float>::infinity();
    for (const size_t axis : {size_t{2}, size_t{1}, size_t{0}}) squares = transform_axis(squares, axis, progress);
    distance_ = std::move(squares.values);
    // Places are found in their voxels, and triangles in theirs, up to rounding.
    for (float& d : distance_) d = std::max(0.0f, 0.5f * std::sqrt(d) * (1 - 0x1p-22f) - 1e-6f);
    progress.update("clearance", 1);
}

} // namespace scree
