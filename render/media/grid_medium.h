#pragma once

#include "render/media/medium.h"

#include <Imath/ImathBox.h>

#include <memory>

namespace scree {

/// How the values of the grids are interpreted.
struct GridMediumOptions {
    Color scale{1}; ///< sigma_t = scale * density, per unit of length of the scene
    Weight albedo{1}; ///< used if there is no albedo grid
    double g = 0; ///< used if there is no grid of g
    bool nearest = false; ///< no interpolation: sigma_t, albedo and g are constant over a voxel
};

struct GridMediumData;

/// A participating medium whose sigma_t, albedo and g are stored in sparse grids; safe to use from many threads.
///
/// All points, directions and lengths are in render coordinates. Values are trilinear between voxel centres (or
/// nearest). Grids are stored as bricks of 8^3 cells, each with a majorant; a walk skips many empty bricks at once.
/// Inside a brick it uses delta tracking (Woodcock 1965) and residual ratio tracking (Novak et al. 2014). If a brick is
/// constant, or so dense and uneven that tracking would take many steps, it uses the closed form of the interpolant's
/// optical depth instead. So the mean number of steps of a walk is bounded for any densities. Made by
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
