#pragma once

#include "packing/solids/domain.h"

#include <cstdint>
#include <memory>

namespace scree {

/// Cheap bounds on the signed distance to a domain's surface, from an OpenVDB level set: where these bounds decide a
/// question, the exact test with CGAL is not needed. Any thread may ask.
class DistanceField {
public:
    /// The signed distance, positive inside, lies in lo..hi (scene units); a bound is infinite where it is unknown.
    struct Interval {
        double lo, hi;
    };

    /// cells: voxels along the longest side of the domain's bounds. Only a narrow band is stored; beyond it only the
    /// sign and a lower bound of the distance are known. The interval always holds: it includes voxel and float errors.
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
