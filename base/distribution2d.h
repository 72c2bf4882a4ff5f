#pragma once

#include "base/math.h"

#include <vector>

namespace scree {

/// A piecewise constant density over the unit square, cell values given row by row.
class Distribution2D {
public:
    Distribution2D() = default;
    /// values: height * width non-negative numbers; if all are zero, the density is uniform.
    Distribution2D(const std::vector<float>& values, size_t width, size_t height);

    /// A point of the unit square (x along a row) with density `pdf(point)`.
    V2d sample(double u1, double u2) const;
    /// Density at a point; integrates to 1 over the unit square.
    double pdf(const V2d& point) const;

private:
    size_t width_ = 0, height_ = 0;
    std::vector<double> rows_; // height + 1 cumulative sums of the rows, the last is 1
    std::vector<double> cells_; // height * (width + 1) cumulative sums within each row, each row's last is 1
};

} // namespace scree
