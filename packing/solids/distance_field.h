#pragma once

#include "packing/solids/domain.h"

#include <cstdint>
#include <memory>

namespace scree {

/// Cheap bounds on the signed distance to a domain's surface, from an OpenVDB level set: where they settle a question,
/// CGAL need not be asked. Any thread may ask.
class DistanceField {
public:
    /// Signed distance, positive inside, lies in lo..hi (scene units); infinite where nothing is known.
    struct Interval {
        double lo, hi;
    };

    /// cells: voxels along the longest side of the domain's bounds. A narrow band is stored; beyond it only the sign
    /// and that the surface is farther than the band. It is never wrong: voxel and float errors are in the interval.
    DistanceField(const Domain& domain, int cells = 256);
    ~DistanceField();
    DistanceField(const DistanceField&) = delete;
    DistanceField& operator=(const DistanceField&) = delete;

    Interval signed_distance(const Imath::V3d& point) const;
    uint64_t bytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
