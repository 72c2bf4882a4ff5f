#pragma once

#include "ingest/support/progress.h"
#include "render/math.h"

#include <Imath/ImathBox.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Triangles over positions that live elsewhere.
struct TriangleView {
    std::span<const V3f> positions;
    std::span<const std::array<uint32_t, 3>> triangles;
};

/// How far it certainly is from a place to the nearest of many triangles: a walk that is shorter needs no test against them.
///
/// A dense grid of voxels holds, for each voxel's centre, the distance to the nearest cell of half the edge through which a triangle may
/// pass (an exact distance transform, by axes: Saito and Toriwaki 1994). The bound is never above the distance, and mostly less than two voxels below it.
class ClearanceField {
public:
    /// Knows nothing: the clearance is 0 everywhere.
    ClearanceField() = default;
    /// box: where places will be asked about; triangles beyond it count as well. voxels: along its longest edge. Throws InputError (an infinite
    /// box or triangle, voxels not in 1..1024), Cancelled.
    ClearanceField(std::span<const TriangleView> meshes, const Imath::Box3d& box, const Progress& progress, int voxels = 100);

    /// A lower bound of the distance from a place to the nearest triangle; 0 outside of the box; infinite where there are none.
    double clearance(const V3d& place) const
    {
        const V3d index = (place - origin_) * per_length_;
        // False for NaN as well.
        if (!(index.x >= 0 && index.y >= 0 && index.z >= 0 && index.x < size_[0] && index.y < size_[1] && index.z < size_[2])) return 0;
        const int x = static_cast<int>(index.x), y = static_cast<int>(index.y), z = static_cast<int>(index.z);
        const V3d away(index.x - x - 0.5, index.y - y - 0.5, index.z - z - 0.5);
        const float from_centre = distance_[(static_cast<size_t>(x) * static_cast<size_t>(size_[1]) + static_cast<size_t>(y)) * static_cast<size_t>(size_[2]) + static_cast<size_t>(z)];
        return std::max(0.0, (from_centre - std::sqrt(away.dot(away))) * voxel_);
    }

    double voxel() const { return voxel_; }
    uint64_t bytes() const { return distance_.size() * sizeof(float); }

private:
    V3d origin_{0};
    double voxel_ = 0, per_length_ = 0;
    std::array<int, 3> size_{0, 0, 0};
    std::vector<float> distance_; ///< from centres, in voxels, rounded down
};

} // namespace scree
