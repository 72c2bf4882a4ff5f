#pragma once

#include "render/media/homogeneous_medium.h"
#include "render/media/medium_pyramid.h"
#include "render/stf/shell_sampler.h"
#include "render/stf/stf_form.h"

#include <memory>

namespace scree {

/// A shell around a place, and the medium in it.
struct FittingShell {
    const ShellSampler* shell = nullptr; ///< null with the diffusion form
    double length = 0; ///< radius
    double radius = 0; ///< in mean free paths
    double sigma_t = 0;
    Weight albedo{1};
    double sampled_albedo = 1; ///< that the shell's records are drawn by; no channel's is larger
    PhaseFunction phase; ///< that its records were drawn from

    /// What a record of so many scatterings counts per channel, over what the sampled albedo's does.
    Weight ratio(uint32_t events) const
    {
        const auto of = [&](double a) {
            if (a == sampled_albedo) return 1.0;
            return a > 0 ? std::exp(events * std::log(a / sampled_albedo)) : 0.0;
        };
        return {of(albedo.x), of(albedo.y), of(albedo.z)};
    }
};

/// A ball in which a medium of grids is the same, and the shell that fits in it.
struct SameBall {
    double length = 0; ///< radius
    MediumMean mean;
    size_t number = 0; ///< of the largest shell that is not larger

    /// Of that shell.
    double radius() const { return std::min(length, Stf::radius(number) / mean.sigma_t); }
};

/// Finds a ball around a place, where nothing but the medium is within `clear`; false: none has room for a shell.
/// count: of shells there are.
bool fit_ball(const MediumPyramid& medium, const V3d& place, double clear, size_t count, SameBall& ball);

/// What light reaches a shell in a medium of grids from outside of a clear ball, `beyond` larger than it: how often
/// light is to be looked for.
///
/// The grid may be thinner there: then this is a guess, and must not be so low that the light it lets through counts
/// for much.
inline double light_reaching(double beyond, double sigma_t) { return std::max(0.1, std::exp(-sigma_t * beyond)); }

/// The shells that light may go through in a medium, which is achromatic; safe to use from many threads.
class MediumShells {
public:
    /// stf: of the medium's phase function (or, by form, of one that stands for it). count: of its shells to use.
    MediumShells(std::shared_ptr<const Stf> stf, const HomogeneousMedium& medium, size_t count, StfForm form);
    /// stfs: of growing g, from the least to the largest in the medium; a shell where g is between two is of either, by
    /// chance.
    MediumShells(std::vector<std::shared_ptr<const Stf>> stfs, std::unique_ptr<const MediumPyramid> medium,
                 size_t count, StfForm form);

    /// The largest shell around a place, where nothing but the medium is within `clear`. False: none fits. u: in (0,
    /// 1), where the choice is left to chance.
    bool fit(const V3d& place, double clear, double u, FittingShell& fitting) const;

    /// Of the smallest ball that may hold a shell.
    double least_length() const;
    StfForm form() const { return form_; }
    bool needs_chance() const { return grid_ || form_ == StfForm::interpolated; }
    uint64_t bytes() const { return bytes_; }

private:
    /// Samplers of one phase function by shell, for one albedo.
    using Samplers = std::vector<ShellSampler>;

    bool fit_in_grid(const V3d& place, double clear, double u, FittingShell& fitting) const;
    /// Puts in the shell of a number, or one as large as fits; radius: that fits, in mean free paths.
    void choose(const Samplers& shells, size_t number, double radius, double u, FittingShell& fitting) const;
    void add_samplers(const Stf& stf, double albedo, size_t count);

    StfForm form_;
    uint64_t bytes_ = 0;
    std::vector<std::shared_ptr<const Stf>> stfs_;
    std::vector<Samplers> samplers_; ///< by stf, and within by albedo
    std::vector<double> albedos_; ///< that they are for, growing
    FittingShell everywhere_; ///< of a homogeneous medium
    std::unique_ptr<const MediumPyramid> grid_;
};

} // namespace scree
