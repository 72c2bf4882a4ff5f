#pragma once

#include "render/medium/brick_field.h"

namespace scree {

/// Least and largest values of a field over cells of growing size; of one plane, in field coordinates.
class RangePyramid {
public:
    RangePyramid(const BrickField& field, size_t plane);

    struct Range {
        float low, high;
    };
    /// Of all values in the box, or of some more around it.
    Range over(const Imath::Box3d& box) const;
    uint64_t bytes() const;

private:
    struct Level {
        std::array<int64_t, 3> size{};
        std::vector<Range> cells;
    };
    double width_ = 0; ///< of a cell of the first level, in field coordinates
    Range background_;
    std::vector<Level> levels_;
};

} // namespace scree
