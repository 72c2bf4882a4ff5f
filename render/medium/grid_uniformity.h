#pragma once

#include "render/medium/grid_medium.h"

#include <memory>

namespace scree {

/// Tells how far around a place a medium of grids is the same, within a tolerance. The medium is achromatic.
class GridUniformity {
public:
    /// tolerance: of sigma_t, 1 - albedo and 1 - g, as parts of their values at the place; more than 0.
    GridUniformity(const GridMedium& medium, double tolerance);
    ~GridUniformity();

    /// Values anywhere in the medium lie in these.
    struct Extremes {
        float albedo_low, albedo_high; ///< of the largest channel's
        float g_low, g_high;
    };
    Extremes extremes() const;
    /// Whether the medium is the same in a ball, as sigma_t, albedo and g are at its centre; render coordinates.
    bool holds(const V3d& centre, double radius, double sigma_t, const C3f& albedo, double g) const;
    uint64_t bytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
