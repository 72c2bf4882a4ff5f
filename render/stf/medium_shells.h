#pragma once

#include "render/medium/homogeneous_medium.h"
#include "render/stf/shell_sampler.h"
#include "render/stf/stf_form.h"

#include <memory>

namespace scree {

/// A shell around a place, and the medium in it.
struct FittingShell {
    const ShellSampler* shell = nullptr; ///< null with the diffusion form
    double length = 0;     ///< radius
    double radius = 0;     ///< in mean free paths
    double sigma_t = 0;
    C3f albedo{1};
    float sampled_albedo = 1; ///< that the shell's records are drawn by; no channel's is larger
    PhaseFunction phase;

    /// What a record of so many scatterings counts per channel, over what the sampled albedo's does.
    C3f ratio(uint32_t events) const
    {
        const auto of = [&](float a) {
            if (a == sampled_albedo) return 1.0f;
            return a > 0 ? static_cast<float>(std::exp(events * std::log(double{a} / sampled_albedo))) : 0.0f;
        };
        return {of(albedo.x), of(albedo.y), of(albedo.z)};
    }
};

/// The shells that light may go through in a medium; safe to use from many threads.
class MediumShells {
public:
    /// stf: of the medium's phase function (or, by form, of one that stands for it). The medium is achromatic.
    /// count: of its shells to use.
    MediumShells(std::shared_ptr<const Stf> stf, const HomogeneousMedium& medium, size_t count, StfForm form);

    /// The largest shell around a place, where nothing but the medium is within `clear`. False: none fits. u: in (0, 1), for the interpolated form.
    bool fit(double clear, double u, FittingShell& fitting) const;

    StfForm form() const { return form_; }
    uint64_t bytes() const;

private:
    std::shared_ptr<const Stf> stf_;
    StfForm form_;
    double sigma_t_;
    C3f albedo_;
    std::shared_ptr<const PhaseTable> phase_table_;
    PhaseFunction phase_;
    float sampled_albedo_;
    std::vector<ShellSampler> shells_;
};

} // namespace scree
