#pragma once

#include "render/media/medium.h"

#include <limits>
#include <memory>

namespace scree {

/// A medium that is the same everywhere; lengths in render coordinates.
class HomogeneousMedium final : public Medium {
public:
    /// sigma_t: extinction coefficient, 0 or more. albedo: 0..1. g: Henyey-Greenstein asymmetry, -1 < g < 1.
    HomogeneousMedium(const Imath::V3d& sigma_t, const Weight& albedo, double g);
    HomogeneousMedium(const Imath::V3d& sigma_t, const Weight& albedo, std::shared_ptr<const PhaseTable> table);

    MediumEvent event(const V3d&, const V3d&, double t0, double t1, SpectralState& state,
                      Sampler& sampler) const override
    {
        return event(t0, t1, state, sampler);
    }
    Color transmittance(const V3d&, const V3d&, double t0, double t1, Sampler&) const override
    {
        return transmittance(t1 - t0);
    }
    bool is_achromatic() const override { return sigma_t_.x == sigma_t_.y && sigma_t_.x == sigma_t_.z; }
    const HomogeneousMedium* uniform() const override { return this; }
    Color sigma_t(const V3d&) const override { return Color(sigma_t_); }
    Weight albedo(const V3d&) const override { return albedo_; }
    double g(const V3d&) const override { return phase_.mean_cosine(); }
    double largest_sigma_t() const override { return std::max({sigma_t_.x, sigma_t_.y, sigma_t_.z}); }
    double voxel() const override { return std::numeric_limits<double>::infinity(); }
    Imath::Box3d bounds() const override { return Imath::Box3d(V3d(-infinite), V3d(infinite)); }
    uint64_t bytes() const override { return sizeof(*this); }

    /// The first scattering in t0 < t < t1.
    MediumEvent event(double t0, double t1, SpectralState& state, Sampler& sampler) const;
    Color transmittance(double length) const;
    const Imath::V3d& sigma_t() const { return sigma_t_; }
    const Weight& albedo() const { return albedo_; }
    const PhaseFunction& phase() const { return phase_; }
    const std::shared_ptr<const PhaseTable>& phase_table() const { return table_; } ///< or null

private:
    static constexpr double infinite = std::numeric_limits<double>::infinity();

    Imath::V3d sigma_t_;
    Weight albedo_;
    std::shared_ptr<const PhaseTable> table_;
    PhaseFunction phase_;
};

} // namespace scree
