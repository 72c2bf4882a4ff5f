#pragma once

#include "packing/solids/exact_distance.h"

#include <cstdint>
#include <vector>

namespace scree {

/// A list of triangles that contains the nearest triangle of every place in a region; a smaller region picks its list
/// from the list of a larger one.
///
/// Lists can be refilled many times without allocation.
class NearTriangles {
public:
    /// scale: as for bound_distance.
    void fill(const std::vector<Corners>& triangles, double scale);

    /// Bounds on the distance to the nearest triangle; the list must not be empty. Remembers the place for `pick`.
    DistanceBounds distance(const Imath::V3d& place);

    /// Takes from the list of a larger region all triangles that can be within `within` of the place that was last
    /// passed to its `distance`.
    void pick(const NearTriangles& larger, double within);

private:
    void resize(size_t n);

    /// A flat cylinder around each triangle: within `radius` of the triangle's middle, and within `thickness` of its
    /// plane. Its distance is fast to compute for many triangles at once. Scaled.
    std::vector<double> x_, y_, z_, normal_x_, normal_y_, normal_z_, radius_, thickness_;
    std::vector<const Corners*> corners_;
    double scale_ = 1;
    std::vector<double> least_; ///< lower bounds on the distances from the last place
};

} // namespace scree
