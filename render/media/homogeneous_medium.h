#pragma once

#include "base/sampler.h"
#include "render/media/medium_event.h"

#include <memory>

namespace scree {

/// A medium that is the same everywhere; lengths in render coordinates.
class HomogeneousMedium {
public:
    /// sigma_t: extinction coefficient, 0 or more. albedo: 0..1. g: Henyey-Greenstein asymmetry, -1 < g < 1.
    HomogeneousMedium(const Imath::V3d& sigma_t, const Weight& albedo, double g);
    HomogeneousMedium(const Imath::V3d& sigma_t, const Weight& albedo, std::shared_ptr<const PhaseTable> table);

    bool is_achromatic() const { return sigma_t_.x == sigma_t_.y && sigma_t_.x == sigma_t_.z; }
    /// The first scattering in t0 < t < t1.
    MediumEvent event(double t0, double t1, SpectralState& state, Sampler& sampler) const;
    Color transmittance(double length) const;
    const Imath::V3d& sigma_t() const { return sigma_t_; }
    const Weight& albedo() const { return albedo_; }
    const PhaseFunction& phase() const { return phase_; }
    const std::shared_ptr<const PhaseTable>& phase_table() const { return table_; } ///< or null

private:
    Imath::V3d sigma_t_;
    Weight albedo_;
    std::shared_ptr<const PhaseTable> table_;
    PhaseFunction phase_;
};

} // namespace scree
