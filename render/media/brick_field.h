#pragma once

// Private to the medium: sparse fields on a regular grid.

#include "base/math.h"

#include <Imath/ImathBox.h>

#include <array>
#include <vector>

namespace scree {

/// A sparse field of 1 or 3 floats on a regular grid, in bricks of 8^3 cells.
///
/// Field coordinates: cell (i, j, k) is the cube from (i, j, k) to (i + 1, j + 1, k + 1). The corners of a cell are
/// voxel centres. The field is trilinear in a cell (or, if `nearest`, it is the value of the corner (i, j, k)). A brick
/// stores all 9^3 corners of its cells, so that a lookup needs one brick only. Regions of 8^(3 l) bricks form a tree;
/// the largest regions are in a dense table at its top.
struct BrickField {
    static constexpr int32_t width = 8; ///< cells of a brick along an axis
    static constexpr int32_t stride = 9; ///< corners of a brick along an axis
    static constexpr size_t corners = size_t{stride} * stride * stride;

    /// The values of a region: all corners of a brick, plane by plane, x slowest; or one value per plane if it is
    /// constant.
    struct Content {
        uint64_t offset = 0; ///< into values
        bool constant = false;
        std::array<float, 3> low{0, 0, 0}, high{0, 0, 0}; ///< range of each plane
    };

    /// The region that contains a point: one brick, or a larger region that is empty or constant.
    struct Region {
        int32_t content = -1; ///< -1: empty (the background)
        int32_t size = 1; ///< bricks along an axis, a power of 8
    };

    int planes = 1;
    bool nearest = false;
    std::array<float, 3> background{0, 0, 0};
    std::array<int32_t, 3> bricks{0, 0, 0}; ///< bricks along each axis; all 0: the field is empty
    Imath::Box3d support; ///< bounds of all that is not background, in field coordinates
    std::vector<Content> contents;
    std::vector<float> values;

    /// The region that contains brick b; each component of b is in 0..bricks-1.
    Region find(const std::array<int32_t, 3>& b) const
    {
        const int top = 3 * levels;
        uint32_t entry =
            root[(static_cast<size_t>(b[0] >> top) * root_size[1] + static_cast<size_t>(b[1] >> top)) * root_size[2] +
                 static_cast<size_t>(b[2] >> top)];
        int shift = top;
        while ((entry & 3) == entry_node) {
            shift -= 3;
            const auto child = [&](int32_t x) { return static_cast<size_t>(x >> shift) & 7; };
            entry = nodes[entry >> 2][child(b[0]) << 6 | child(b[1]) << 3 | child(b[2])];
        }
        return {(entry & 3) == entry_content ? static_cast<int32_t>(entry >> 2) : -1, 1 << shift};
    }

    /// The value of one plane at point p of a non-constant brick. low: the first corner of the brick (field
    /// coordinates); a point outside the brick is moved to its nearest face. offset: Content::offset, plus `corners`
    /// for each earlier plane.
    double at_brick(uint64_t offset, const std::array<int32_t, 3>& low, const V3d& p) const;

    /// The value at any point (field coordinates); the background outside `support`.
    std::array<double, 3> at(const V3d& p) const;

    uint64_t bytes() const;

    // The tree. The two low bits of an entry say whether it is empty, a node or a content; the bits above are its
    // index.
    static constexpr uint32_t entry_empty = 0, entry_node = 1, entry_content = 2;
    int levels = 0; ///< levels of nodes below the table
    std::array<size_t, 3> root_size{0, 0, 0};
    std::vector<uint32_t> root;
    std::vector<std::array<uint32_t, 512>> nodes;
};

inline double BrickField::at_brick(uint64_t offset, const std::array<int32_t, 3>& low, const V3d& p) const
{
    // Rounding may put the point slightly outside the brick that the ray is in.
    constexpr double last = width - 1;
    const double x = p.x - low[0], y = p.y - low[1], z = p.z - low[2];
    const double i = std::min(std::max(std::floor(x), 0.0), last), j = std::min(std::max(std::floor(y), 0.0), last),
                 k = std::min(std::max(std::floor(z), 0.0), last);
    const float* v = values.data() + offset +
                     static_cast<size_t>((static_cast<int32_t>(i) * stride + static_cast<int32_t>(j)) * stride +
                                         static_cast<int32_t>(k));
    if (nearest) return double{v[0]};
    const auto weight = [](double f) { return static_cast<float>(std::min(std::max(f, 0.0), 1.0)); };
    const float fx = weight(x - i), fy = weight(y - j), fz = weight(z - k);
    const auto along_z = [&](const float* a) { return a[0] + (a[1] - a[0]) * fz; };
    constexpr size_t one_x = size_t{stride} * stride, one_y = stride;
    const float v00 = along_z(v), v01 = along_z(v + one_y), v10 = along_z(v + one_x), v11 = along_z(v + one_x + one_y);
    const float v0 = v00 + (v01 - v00) * fy, v1 = v10 + (v11 - v10) * fy;
    return double{v0 + (v1 - v0) * fx};
}

} // namespace scree
