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
    double length = 0; ///< radius as a length
    double radius = 0; ///< the paper's r: radius in mean free paths
    double sigma_t = 0;
    Weight albedo{1};
    double sampled_albedo = 1; ///< that the shell's records are drawn with; at least the albedo of every channel
    PhaseFunction phase; ///< that the shell's records were drawn from

    /// The weight per channel of a record of `events` scatterings: (albedo / sampled_albedo)^events.
    Weight ratio(uint32_t events) const
    {
        const auto of = [&](double a) {
            if (a == sampled_albedo) return 1.0;
            return a > 0 ? std::exp(events * std::log(a / sampled_albedo)) : 0.0;
        };
        return {of(albedo.x), of(albedo.y), of(albedo.z)};
    }
};

/// A ball in which a grid medium is the same everywhere, within a tolerance, and the largest shell that fits in it.
struct SameBall {
    double length = 0; ///< radius as a length
    MediumMean mean;
    size_t number = 0; ///< of the largest shell that is not larger than the ball

    /// Radius of that shell, as a length.
    double radius() const { return std::min(length, Stf::radius(number) / mean.sigma_t); }
};

/// Finds a ball around a place; false if none has room for a shell. clear: distance within which there is nothing but
/// the medium. count: number of shells available.
bool fit_ball(const MediumPyramid& medium, const V3d& place, double clear, size_t count, SameBall& ball);

/// Estimates the share of outside light that reaches a shell in a grid medium through `beyond`, the clear distance
/// around the shell; light is sampled with this probability.
///
/// The grid may be thinner there, so this is a guess. It must not be too low: the light that does come through would
/// then have a large weight.
inline double light_reaching(double beyond, double sigma_t) { return std::max(0.1, std::exp(-sigma_t * beyond)); }

/// The shells that light may go through in a medium of achromatic sigma_t; safe to use from many threads.
class MediumShells {
public:
    /// stf: of the medium's phase function, or of the one that `form` replaces it by. count: number of its shells to
    /// use.
    MediumShells(std::shared_ptr<const Stf> stf, const HomogeneousMedium& medium, size_t count, StfForm form);
    /// stfs: in ascending g, from the least to the largest in the medium; where g is between two, fit() picks one of
    /// them at random.
    MediumShells(std::vector<std::shared_ptr<const Stf>> stfs, std::unique_ptr<const MediumPyramid> medium,
                 size_t count, StfForm form);

    /// Finds the largest shell around a place; false if none fits. clear: distance within which there is nothing but
    /// the medium. u: random number in (0, 1), see needs_chance().
    bool fit(const V3d& place, double clear, double u, FittingShell& fitting) const;

    /// Radius, as a length, of the smallest ball that may hold a shell.
    double least_length() const;
    StfForm form() const { return form_; }
    /// Whether fit() uses its random number.
    bool needs_chance() const { return grid_ || form_ == StfForm::interpolated; }
    uint64_t bytes() const { return bytes_; }

private:
    /// Samplers of one phase function by shell, for one albedo.
    using Samplers = std::vector<ShellSampler>;

    bool fit_in_grid(const V3d& place, double clear, double u, FittingShell& fitting) const;
    /// Sets the shell of a number, or in the interpolated form one of radius `radius`: the largest that fits, in mean
    /// free paths.
    void choose(const Samplers& shells, size_t number, double radius, double u, FittingShell& fitting) const;
    void add_samplers(const Stf& stf, double albedo, size_t count);

    StfForm form_;
    uint64_t bytes_ = 0;
    std::vector<std::shared_ptr<const Stf>> stfs_;
    std::vector<Samplers> samplers_; ///< by stf, and for each stf by albedo
    std::vector<double> albedos_; ///< of samplers_, ascending
    FittingShell everywhere_; ///< in a homogeneous medium: what does not depend on the place
    std::unique_ptr<const MediumPyramid> grid_;
};

} // namespace scree
