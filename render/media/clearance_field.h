#pragma once

#include "base/math.h"
#include "base/progress.h"
#include "render/media/triangle_tree.h"

#include <Imath/ImathBox.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace scree {

/// Lower bounds of the distance from a point to the nearest of many triangles: a walk that is shorter needs no test
/// against them.
///
/// A dense lattice stores squared distances, and a tree stores the triangles. d^2(p) - |p|^2 is the minimum of many
/// affine functions and so concave (Cannarsa and Sinestrari 2004, 2.2): inside a voxel it is never below the
/// interpolation of its corner values. The interpolation is the bound in voxels where it is known to be tight;
/// elsewhere the tree gives the bound. Keeps no reference to the meshes.
class ClearanceField {
public:
    /// The empty field: its clearance is 0 everywhere.
    ClearanceField() = default;
    /// box: bounds of the points that will be queried; triangles outside it count as well. voxels: along its longest
    /// edge. Throws InputError (a box or triangle that is not finite, a triangle 2^100 boxes away, a box 2^50 times its
    /// size from the origin, voxels not in 1..1024), Cancelled.
    ClearanceField(std::span<const TriangleView> meshes, const Imath::Box3d& box, const Progress& progress,
                   int voxels = 64);

    /// A lower bound of the distance from a point to the nearest triangle; 0 outside the box; infinite if there are no
    /// triangles. For distances of 1e-6 of the box or more the bound was at least 0.97 of the distance in all tests,
    /// mostly above 0.999 near triangles. It is lower only within 1e-5 of needle triangles, whose normals are
    /// inaccurate even in double precision.
    double clearance(const V3d& place) const { return clearance(place, 1, 0); }
    /// A rougher bound that takes less time near the triangles: mostly at least 0.7 of the distance; may be 0 where the
    /// distance is `least` or less.
    double rough_clearance(const V3d& place, double least = 0) const { return clearance(place, 0.5, least); }

    /// An upper bound of the clearance over the box.
    double largest() const { return largest_; }
    double voxel() const { return voxel_; }
    uint64_t bytes() const { return squares_.size() * (sizeof(float) + sizeof(uint64_t)) + tree_.bytes(); }

private:
    /// enough: the interpolation is used if it gives at least this part of the squared distance; otherwise the tree is
    /// queried.
    double clearance(const V3d& place, double enough, double least) const
    {
        const V3d index = (place - origin_) * per_length_;
        // False for NaN as well.
        if (!(index.x >= 0 && index.y >= 0 && index.z >= 0 && index.x < size_[0] && index.y < size_[1] &&
              index.z < size_[2]))
            return 0;
        const int x = static_cast<int>(index.x), y = static_cast<int>(index.y), z = static_cast<int>(index.z);
        const size_t corner =
            (static_cast<size_t>(x) * step_[0]) + static_cast<size_t>(y) * step_[1] + static_cast<size_t>(z);
        if (squares_.empty()) return std::numeric_limits<double>::infinity();
        const float* s = &squares_[corner];
        const double tx = index.x - x, ty = index.y - y, tz = index.z - z, square = interpolate(s, tx, ty, tz);
        if (!(s[0] > 0)) {
            const double most = std::sqrt(double{-s[0]}) + std::sqrt(tx * tx + ty * ty + tz * tz);
            if (most * voxel_ < least) return 0;
            if (enough == 1) return near(place, x, y, z, false, 0);
            if (!(square > enough * most * most)) return near(place, x, y, z, true, least);
        }
        return std::sqrt(square) * rounded_voxel_;
    }

    double near(const V3d& place, int x, int y, int z, bool is_rough, double least) const;
    /// The square of the bound, in voxels, at fractions of a voxel from its lower corner.
    double interpolate(const float* s, double tx, double ty, double tz) const
    {
        const auto along_z = [&](size_t at) {
            return (1 - tz) * double{std::abs(s[at])} + tz * double{std::abs(s[at + 1])};
        };
        const double low = (1 - ty) * along_z(0) + ty * along_z(step_[1]),
                     high = (1 - ty) * along_z(step_[0]) + ty * along_z(step_[0] + step_[1]);
        // The interpolation of |p|^2 exceeds |p|^2 by the second term.
        return (1 - tx) * low + tx * high - (tx * (1 - tx) + ty * (1 - ty) + tz * (1 - tz));
    }
    void fill_squares(const Progress& progress);

    V3d origin_{0};
    double voxel_ = 0, per_length_ = 0, rounded_voxel_ = 0, scale_ = 1;
    double largest_ = 0;
    std::array<int, 3> size_{0, 0, 0};
    std::array<size_t, 2> step_{0, 0};
    /// Squared distances of the lattice points, in voxels, rounded down. Negative or 0 at a voxel's lowest corner:
    /// query the tree for points in that voxel.
    std::vector<float> squares_;
    TriangleTree tree_;
    /// The tree's entries for each voxel where the tree is queried: 21 bits each, plus the top bit, which marks them as
    /// known. They are computed at the first query. Threads that compute them at the same time get the same result, so
    /// that relaxed memory order is enough.
    std::unique_ptr<std::atomic<uint64_t>[]> entries_;
};

} // namespace scree
