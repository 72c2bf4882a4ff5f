#pragma once

#include "base/sampler.h"
#include "render/media/medium_event.h"

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
class GridMedium {
public:
    explicit GridMedium(std::shared_ptr<const GridMediumData> data);

    /// The first scattering in t0 < t < t1 along o + t d (unit d); t1 may be infinite.
    MediumEvent event(const V3d& o, const V3d& d, double t0, double t1, SpectralState& state, Sampler& sampler) const;

    /// Unbiased estimate of the transmittance per channel over t0..t1, in 0..1; Russian roulette below 0.1.
    Color transmittance(const V3d& o, const V3d& d, double t0, double t1, Sampler& sampler) const;

    /// A box around the non-empty part of the medium; empty if all of it is empty.
    Imath::Box3d bounds() const;
    /// Whether sigma_t is the same for all channels everywhere; then event() does not change the SpectralState.
    bool is_achromatic() const;
    double largest_sigma_t() const; ///< of any channel
    uint64_t bytes() const;
    double voxel() const; ///< shortest edge of a voxel of the density
    /// The coefficients at any point; sigma_t per channel.
    Color sigma_t(const V3d& p) const;
    Weight albedo(const V3d& p) const;
    double g(const V3d& p) const;

private:
    std::shared_ptr<const GridMediumData> data_;
};

} // namespace scree
