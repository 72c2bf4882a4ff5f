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

/// How far it certainly is from a place to the nearest of many triangles: a walk that is shorter needs no test against
/// them.
///
/// A dense lattice holds squares of distances, and a tree the triangles. d^2(p) - |p|^2 is the least of many affine
/// functions and so concave (Cannarsa and Sinestrari 2004, 2.2): in a voxel it is nowhere below the interpolation
/// between its values at the corners. That is the bound where it is known to be tight, and the tree's distance
/// elsewhere. Keeps no reference to the meshes.
class ClearanceField {
public:
    /// Knows nothing: the clearance is 0 everywhere.
    ClearanceField() = default;
    /// box: where places will be asked about; triangles beyond it count as well. voxels: along its longest edge. Throws
    /// InputError (an infinite box or triangle, one 2^100 boxes away, a box 2^50 times its size from the origin, voxels
    /// not in 1..1024), Cancelled.
    ClearanceField(std::span<const TriangleView> meshes, const Imath::Box3d& box, const Progress& progress,
                   int voxels = 64);

    /// A lower bound of the distance from a place to the nearest triangle; 0 outside of the box; infinite where there
    /// are none. From 1e-6 of the box on at least 0.97 of it in all tests, mostly above 0.999 near triangles; less only
    /// within 1e-5 of needles whose normals double hardly knows.
    double clearance(const V3d& place) const { return clearance(place, 1, 0); }
    /// Likewise, mostly at least 0.7 of the distance, or 0 where it is not more than `least`, in less time near the
    /// triangles.
    double rough_clearance(const V3d& place, double least = 0) const { return clearance(place, 0.5, least); }

    /// Of all places in the box, or more than that.
    double largest() const { return largest_; }
    double voxel() const { return voxel_; }
    uint64_t bytes() const { return squares_.size() * (sizeof(float) + sizeof(uint64_t)) + tree_.bytes(); }

private:
    /// enough: part of the square of the distance that the interpolation must find, lest the tree be asked.
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
        // The interpolation of |p|^2 is above it by this.
        return (1 - tx) * low + tx * high - (tx * (1 - tx) + ty * (1 - ty) + tz * (1 - tz));
    }
    void fill_squares(const Progress& progress);

    V3d origin_{0};
    double voxel_ = 0, per_length_ = 0, rounded_voxel_ = 0, scale_ = 1;
    double largest_ = 0;
    std::array<int, 3> size_{0, 0, 0};
    std::array<size_t, 2> step_{0, 0};
    std::vector<float> squares_; ///< of distances of lattice points, in voxels, rounded down; negative or 0 where the
                                 ///< tree is to be asked in the voxel above
    TriangleTree tree_;
    /// Of voxels where the tree is asked: its entries for them, of 21 bits each, and a bit that is set. Found when
    /// first asked; whoever else finds them meanwhile finds the same, so that no order is needed.
    std::unique_ptr<std::atomic<uint64_t>[]> entries_;
};

} // namespace scree
