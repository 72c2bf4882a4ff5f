#pragma once

// Private to the medium: sparse fields on a regular grid.

#include "base/math.h"

#include <Imath/ImathBox.h>

#include <array>
#include <vector>

namespace scree {

/// A sparse field of 1 or 3 floats on a regular grid, in bricks of 8^3 cells.
///
/// Field coordinates: cell (i, j, k) is the cube from (i, j, k) to (i + 1, j + 1, k + 1), its corners are voxel
/// centres, and the field is trilinear in it (or, if nearest, the value of the corner (i, j, k)). A brick holds all 9^3
/// corners of its cells, so that no lookup leaves it. Regions of 8^(3 l) bricks hang in a tree under a dense table of
/// the largest.
struct BrickField {
    static constexpr int32_t width = 8; ///< cells of a brick along an axis
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
        int32_t size = 1; ///< in bricks along an axis, a power of 8
    };

    int planes = 1;
    bool nearest = false;
    std::array<float, 3> background{0, 0, 0};
    std::array<int32_t, 3> bricks{0, 0, 0}; ///< along each axis; all 0: the field is empty
    Imath::Box3d support; ///< around what is not background, in field coordinates
    std::vector<Content> contents;
    std::vector<float> values;

    /// b: a brick, each component in 0..bricks-1.
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

    /// One plane's value at a place of a brick, not constant, that begins at `low` (field coordinates); places outside
    /// are moved to its faces. offset: the content's, plus `corners` for each plane before.
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
