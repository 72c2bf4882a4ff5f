#pragma once

#include "base/sampler.h"
#include "render/media/medium_event.h"

#include <Imath/ImathBox.h>

#include <memory>

namespace scree {

/// How the numbers of the grids are to be read.
struct GridMediumOptions {
    Color scale{1}; ///< sigma_t = scale * density, per unit of length of the scene
    Weight albedo{1}; ///< where there is no albedo grid
    double g = 0; ///< where there is no grid of g
    bool nearest = false; ///< no interpolation: sigma_t, albedo and g are constant over a voxel
};

struct GridMediumData;

/// A participating medium whose sigma_t, albedo and g stand in sparse grids; safe to use from many threads.
///
/// All places, directions and lengths are in render coordinates. Trilinear between voxel centres (or nearest). Grids
/// are kept as bricks of 8^3 cells with a majorant each, and bricks without density are stepped over many at a time.
/// Within a brick: delta tracking (Woodcock 1965) and residual ratio tracking (Novak et al. 2014); where a brick is
/// constant, or so dense and uneven that these would take many steps, the optical depth of the interpolant in closed
/// form instead. So the steps that a walk takes are bounded in the mean whatever the densities are. Made by
/// make_grid_medium() and read_vdb_medium().
class GridMedium {
public:
    explicit GridMedium(std::shared_ptr<const GridMediumData> data);

    /// The first scattering in t0 < t < t1 along o + t d (unit d); t1 may be infinite.
    MediumEvent event(const V3d& o, const V3d& d, double t0, double t1, SpectralState& state, Sampler& sampler) const;

    /// Unbiased estimate of the transmittance per channel over t0..t1, in 0..1; Russian roulette below 0.1.
    Color transmittance(const V3d& o, const V3d& d, double t0, double t1, Sampler& sampler) const;

    /// A box around everything that is not empty; empty when nothing is.
    Imath::Box3d bounds() const;
    /// sigma_t is the same for all channels everywhere: event() then leaves the SpectralState alone.
    bool is_achromatic() const;
    double largest_sigma_t() const; ///< of any channel
    uint64_t bytes() const;
    double voxel() const; ///< shortest edge of a voxel of the density
    /// Anywhere; sigma_t per channel.
    Color sigma_t(const V3d& p) const;
    Weight albedo(const V3d& p) const;
    double g(const V3d& p) const;

private:
    std::shared_ptr<const GridMediumData> data_;
};

} // namespace scree
