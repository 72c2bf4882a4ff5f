#pragma once

#include "render/media/medium.h"

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
class GridMedium final : public Medium {
public:
    explicit GridMedium(std::shared_ptr<const GridMediumData> data);

    MediumEvent event(const V3d& o, const V3d& d, double t0, double t1, SpectralState& state,
                      Sampler& sampler) const override;
    /// With Russian roulette below 0.1.
    Color transmittance(const V3d& o, const V3d& d, double t0, double t1, Sampler& sampler) const override;
    bool is_achromatic() const override;
    Color sigma_t(const V3d& p) const override;
    Weight albedo(const V3d& p) const override;
    double g(const V3d& p) const override;
    double largest_sigma_t() const override;
    double voxel() const override; ///< shortest edge of a voxel of the density
    Imath::Box3d bounds() const override;
    uint64_t bytes() const override;

private:
    std::shared_ptr<const GridMediumData> data_;
};

} // namespace scree
