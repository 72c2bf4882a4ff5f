#pragma once

#include "packing/solids/exact_distance.h"

#include <cstdint>
#include <vector>

namespace scree {

/// Triangles one of which is the nearest to any place of a region; smaller regions pick theirs from a larger one's.
///
/// Lists are refilled many times without allocation.
class NearTriangles {
public:
    /// scale: as for bound_distance.
    void fill(const std::vector<Corners>& triangles, double scale);

    /// Bounds of the distance to the nearest; the list must not be empty. Remembers the place for `pick`.
    DistanceBounds distance(const Imath::V3d& place);

    /// From those of a larger region: all that are nowhere farther than `within` from the place it was last asked
    /// about.
    void pick(const NearTriangles& larger, double within);

private:
    void resize(size_t n);

    /// A flat drum around each triangle, whose distance is quickly told for many: within `radius` of the middle, and
    /// within `thickness` of the plane through it. Scaled.
    std::vector<double> x_, y_, z_, normal_x_, normal_y_, normal_z_, radius_, thickness_;
    std::vector<const Corners*> corners_;
    double scale_ = 1;
    std::vector<double> least_; ///< lower bounds of the distances from the last place
};

} // namespace scree
