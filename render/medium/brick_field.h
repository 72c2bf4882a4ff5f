#pragma once

// Private to the medium: sparse fields on a regular grid, and how a ray walks through them.

#include "render/math.h"

#include <Imath/ImathBox.h>

#include <array>
#include <limits>
#include <vector>

namespace scree {

/// A sparse field of 1 or 3 floats on a regular grid, in bricks of 8^3 cells.
///
/// Field coordinates: cell (i, j, k) is the cube from (i, j, k) to (i + 1, j + 1, k + 1), its corners are voxel centres, and
/// the field is trilinear in it (or, if nearest, the value of the corner (i, j, k)). A brick holds all 9^3 corners of
/// its cells, so that no lookup leaves it. Regions of 8^(3 l) bricks hang in a tree under a dense table of the largest.
struct BrickField {
    static constexpr int32_t width = 8;  ///< cells of a brick along an axis
    static constexpr int32_t stride = 9; ///< corners
    static constexpr size_t corners = size_t{stride} * stride * stride;

    /// A region's values: those of a brick, plane by plane, x slowest; or one for each plane where it is constant.
    struct Content {
        uint64_t offset = 0; ///< into values
        bool constant = false;
        std::array<float, 3> low{0, 0, 0}, high{0, 0, 0}; ///< of each plane
    };

    /// What a place lies in: one brick, or a larger region that is empty or constant.
    struct Region {
        int32_t content = -1; ///< -1: empty (the background)
        int32_t size = 1;     ///< in bricks along an axis, a power of 8
    };

    int planes = 1;
    bool nearest = false;
    std::array<float, 3> background{0, 0, 0};
    std::array<int32_t, 3> bricks{0, 0, 0}; ///< along each axis; all 0: the field is empty
    Imath::Box3d support;                   ///< around what is not background, in field coordinates
    std::vector<Content> contents;
    std::vector<float> values;

    /// b: a brick, each component in 0..bricks-1.
    Region find(const std::array<int32_t, 3>& b) const
    {
        const int top = 3 * levels;
        uint32_t entry = root[(static_cast<size_t>(b[0] >> top) * root_size[1] + static_cast<size_t>(b[1] >> top)) * root_size[2] + static_cast<size_t>(b[2] >> top)];
        int shift = top;
        while ((entry & 3) == entry_node) {
            shift -= 3;
            const auto child = [&](int32_t x) { return static_cast<size_t>(x >> shift) & 7; };
            entry = nodes[entry >> 2][child(b[0]) << 6 | child(b[1]) << 3 | child(b[2])];
        }
        return {(entry & 3) == entry_content ? static_cast<int32_t>(entry >> 2) : -1, 1 << shift};
    }

    /// One plane's value at a place of a brick, not constant, that begins at `low` (field coordinates); places outside are moved to
    /// its faces. offset: the content's, plus `corners` for each plane before.
    double at_brick(uint64_t offset, const std::array<int32_t, 3>& low, const V3d& p) const;

    /// The value anywhere.
    std::array<double, 3> at(const V3d& p) const;

    uint64_t bytes() const;

    // The tree. An entry is empty, a node or a content in its two low bits, and its index above.
    static constexpr uint32_t entry_empty = 0, entry_node = 1, entry_content = 2;
    int levels = 0; ///< of nodes below the table
    std::array<size_t, 3> root_size{0, 0, 0};
    std::vector<uint32_t> root;
    std::vector<std::array<uint32_t, 512>> nodes;
};

inline double BrickField::at_brick(uint64_t offset, const std::array<int32_t, 3>& low, const V3d& p) const
{
    // Rounding may have put the place a little outside of the brick that the ray is in.
    constexpr double last = width - 1;
    const double x = p.x - low[0], y = p.y - low[1], z = p.z - low[2];
    const double i = std::min(std::max(std::floor(x), 0.0), last), j = std::min(std::max(std::floor(y), 0.0), last),
                 k = std::min(std::max(std::floor(z), 0.0), last);
    const float* v = values.data() + offset
                   + static_cast<size_t>((static_cast<int32_t>(i) * stride + static_cast<int32_t>(j)) * stride + static_cast<int32_t>(k));
    if (nearest) return double{v[0]};
    const auto weight = [](double f) { return static_cast<float>(std::min(std::max(f, 0.0), 1.0)); };
    const float fx = weight(x - i), fy = weight(y - j), fz = weight(z - k);
    const auto along_z = [&](const float* a) { return a[0] + (a[1] - a[0]) * fz; };
    constexpr size_t one_x = size_t{stride} * stride, one_y = stride;
    const float v00 = along_z(v), v01 = along_z(v + one_y), v10 = along_z(v + one_x), v11 = along_z(v + one_x + one_y);
    const float v0 = v00 + (v01 - v00) * fy, v1 = v10 + (v11 - v10) * fy;
    return double{v0 + (v1 - v0) * fx};
}

/// A ray in field coordinates, with the parameter of the ray it was made from.
struct FieldRay {
    V3d o, d;
    V3d inverse;                  ///< 1 / d, or what stands for infinity where d is next to 0
    std::array<int32_t, 3> step;  ///< sign of d; 0 where d is next to 0: the ray does not get anywhere along that axis
    std::array<int32_t, 3> ahead; ///< the face where it leaves a cell, in cells from its low one; where step is 0 one beyond: never

    FieldRay(const V3d& origin, const V3d& direction) : o(origin), d(direction)
    {
        for (int k = 0; k < 3; ++k) {
            const size_t a = static_cast<size_t>(k);
            inverse[k] = 1 / d[k];
            const bool moves = std::abs(inverse[k]) < 1e150; // far beyond any voxel's width, far below the other
            if (!moves) inverse[k] = 1e290;
            step[a] = !moves ? 0 : d[k] > 0 ? 1 : -1;
            ahead[a] = !moves ? 2 : d[k] > 0 ? 1 : 0;
        }
    }
    V3d at(double t) const { return o + d * t; }
    /// Narrows t0..t1 to the part inside of the box; false when nothing is left.
    bool clip(const Imath::Box3d& box, double& t0, double& t1) const;
};

/// Where a ray leaves the cell of `size` units that begins at low: through the faces whose distance is the exit (two or three
/// of them in an edge or corner).
///
/// Every step moves on by a cell along an axis at least, and never back: rounding cannot make a walk loop.
struct RayStep {
    std::array<double, 3> faces;
    double exit;

    RayStep(const FieldRay& ray, const std::array<int32_t, 3>& low, int32_t size)
    {
        for (size_t k = 0; k < 3; ++k) faces[k] = (low[k] + ray.ahead[k] * size - ray.o[static_cast<int>(k)]) * ray.inverse[static_cast<int>(k)];
        exit = std::min(std::min(faces[0], faces[1]), faces[2]);
    }
    bool leaves_through(size_t axis) const { return faces[axis] <= exit; }
};

/// Calls visit(content index, low corner in cells, t0, t1) for each region along t0..t1 that is not empty, in order, until it
/// returns true.
template <class Visit> void walk_bricks(const BrickField& field, const FieldRay& ray, double t0, double t1, Visit&& visit)
{
    if (field.bricks[0] == 0 || !ray.clip(field.support, t0, t1)) return;
    std::array<int32_t, 3> brick;
    constexpr double inverse_width = 1.0 / BrickField::width;
    const auto brick_at = [&](const V3d& p, int k, int32_t low, int32_t high) {
        return static_cast<int32_t>(std::min(std::max(std::floor(p[k] * inverse_width), double{0} + low), double{0} + high));
    };
    const V3d start = ray.at(t0);
    for (int k = 0; k < 3; ++k) brick[static_cast<size_t>(k)] = brick_at(start, k, 0, field.bricks[static_cast<size_t>(k)] - 1);
    for (;;) {
        const BrickField::Region region = field.find(brick);
        const int32_t mask = ~(region.size - 1);
        const std::array<int32_t, 3> low{(brick[0] & mask) * BrickField::width, (brick[1] & mask) * BrickField::width, (brick[2] & mask) * BrickField::width};
        const RayStep step(ray, low, region.size * BrickField::width);
        const double t = std::min(std::max(step.exit, t0), t1);
        if (region.content >= 0 && visit(region.content, low, t0, t)) return;
        if (!(step.exit < t1)) return;
        if (region.size > 1) {
            const V3d p = ray.at(t);
            for (int k = 0; k < 3; ++k) {
                const size_t a = static_cast<size_t>(k);
                const int32_t first = brick[a] & mask, last = first + region.size - 1;
                if (step.leaves_through(a)) brick[a] = ray.step[a] > 0 ? last : first;
                else brick[a] = ray.step[a] > 0 ? brick_at(p, k, brick[a], last) : ray.step[a] < 0 ? brick_at(p, k, first, brick[a]) : brick[a];
            }
        }
        bool inside = true;
        for (size_t k = 0; k < 3; ++k) {
            brick[k] += step.leaves_through(k) ? ray.step[k] : 0;
            inside &= static_cast<uint32_t>(brick[k]) < static_cast<uint32_t>(field.bricks[k]);
        }
        if (!inside) return;
        t0 = t;
    }
}

/// Calls visit(low corner of a cell, t0, t1) for each cell of the brick that begins at `low`, until it returns true; true
/// if it did.
template <class Visit>
bool walk_cells(const FieldRay& ray, const std::array<int32_t, 3>& low, double t0, double t1, Visit&& visit)
{
    std::array<int32_t, 3> cell;
    const V3d start = ray.at(t0);
    for (size_t k = 0; k < 3; ++k)
        cell[k] = low[k] + static_cast<int32_t>(std::min(std::max(std::floor(start[static_cast<int>(k)] - low[k]), 0.0), double{BrickField::width - 1}));
    for (;;) {
        const RayStep step(ray, cell, 1);
        const double t = std::min(std::max(step.exit, t0), t1);
        if (visit(cell, t0, t)) return true;
        if (!(step.exit < t1)) return false;
        bool inside = true;
        for (size_t k = 0; k < 3; ++k) {
            cell[k] += step.leaves_through(k) ? ray.step[k] : 0;
            inside &= static_cast<uint32_t>(cell[k] - low[k]) < uint32_t{BrickField::width};
        }
        if (!inside) return false;
        t0 = t;
    }
}

} // namespace scree
