#pragma once

// For tests of media: small grids, and the expected results of walks through them.

#include "render/media/grid_medium_build.h"

#include <functional>

namespace scree {

/// A grid of n^3 voxels, voxel (i, j, k) at h (i, j, k) + shift.
openvdb::FloatGrid::Ptr make_grid(int n, double h, const V3d& shift,
                                  const std::function<double(int, int, int)>& density);

GridMedium make_medium(openvdb::GridBase::ConstPtr density, const GridMediumOptions& options = {},
                       const RenderSpace& space = {});

struct TestRay {
    V3d o, d;
    double t0 = 0, t1 = std::numeric_limits<double>::infinity();
};

/// The optical depth by the midpoint rule over sigma_t(), with n steps.
double optical_depth(const GridMedium& medium, const TestRay& ray, double t0, double t1, int n);

/// Expects that the estimates of event() and transmittance() agree with a known optical depth within 4 standard errors;
/// the standard error of the events' frequency is the exact one.
void expect_depth(const GridMedium& medium, const TestRay& ray, double depth, uint32_t n, uint64_t seed = 1);

} // namespace scree
