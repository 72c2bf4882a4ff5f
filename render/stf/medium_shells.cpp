#include "render/stf/medium_shells.h"

namespace scree {

namespace {

// Where the albedo of a medium varies, there is a sampler at each step of a factor 2 in -log(albedo), down to the least
// albedo; below that, shells carry little light.
constexpr double least_albedo = 0.8;
constexpr double albedo_step = 2;

/// The ascending albedos that records are drawn with in a medium of albedo low..high; the last is `high`.
std::vector<double> sampled_albedos(double low, double high)
{
    if (low == high) return {high};
    std::vector<double> albedos{high};
    const double end = -std::log(std::max(low, least_albedo));
    double depth = std::max(-std::log(high), 1e-4);
    for (depth *= albedo_step; depth < end; depth *= albedo_step) albedos.insert(albedos.begin(), std::exp(-depth));
    return albedos;
}

} // namespace

bool fit_ball(const MediumPyramid& medium, const V3d& place, double clear, size_t count, SameBall& ball)
{
    ball.length = std::min(clear, 2 * Stf::radius(count - 1) / medium.extremes().sigma_t_high);
    if (!medium.halve_until_same(place, ball.length, ball.mean)) return false;
    const int number = Stf::largest(ball.length * ball.mean.sigma_t, count);
    if (number < 0) return false;
    ball.number = static_cast<size_t>(number);
    return true;
}

MediumShells::MediumShells(std::shared_ptr<const Stf> stf, const HomogeneousMedium& medium, size_t count, StfForm form)
    : form_(form), stfs_{std::move(stf)}
{
    everywhere_.sigma_t = medium.sigma_t().x;
    everywhere_.albedo = medium.albedo();
    everywhere_.sampled_albedo = max_component(medium.albedo());
    everywhere_.phase =
        stfs_[0]->phase; // not the medium's: light must be weighed by the function that records were drawn from
    add_samplers(*stfs_[0], everywhere_.sampled_albedo, count);
    bytes_ += stfs_[0]->bytes();
}

MediumShells::MediumShells(std::vector<std::shared_ptr<const Stf>> stfs, std::unique_ptr<const MediumPyramid> medium,
                           size_t count, StfForm form)
    : form_(form), stfs_(std::move(stfs)), grid_(std::move(medium))
{
    const MediumPyramid::Extremes& extremes = grid_->extremes();
    albedos_ = sampled_albedos(std::clamp(extremes.albedo_low, 0.0, 1.0), std::clamp(extremes.albedo_high, 0.0, 1.0));
    for (const auto& stf : stfs_) {
        for (const double albedo : albedos_) add_samplers(*stf, albedo, count);
        bytes_ += stf->bytes();
    }
    bytes_ += grid_->bytes();
}

void MediumShells::add_samplers(const Stf& stf, double albedo, size_t count)
{
    Samplers& shells = samplers_.emplace_back();
    for (size_t i = 0; i < std::min(count, stf.shells.size()); ++i) {
        shells.emplace_back(stf.shells[i], albedo);
        bytes_ += shells.back().bytes();
    }
}

void MediumShells::choose(const Samplers& shells, size_t number, double radius, double u, FittingShell& fitting) const
{
    fitting.radius = Stf::radius(number);
    if (form_ == StfForm::interpolated && number + 1 < shells.size()) {
        if (u < std::log2(radius / Stf::radius(number)) * Stf::steps_per_octave) ++number;
        fitting.radius = radius;
    }
    fitting.shell = &shells[number];
}

double MediumShells::least_length() const
{
    return Stf::radius(0) / (grid_ ? grid_->extremes().sigma_t_high : everywhere_.sigma_t);
}

bool MediumShells::fit(const V3d& place, double clear, double u, FittingShell& fitting) const
{
    if (grid_) return fit_in_grid(place, clear, u, fitting);
    const double radius = clear * everywhere_.sigma_t;
    if (form_ == StfForm::diffusion) {
        if (!(radius >= Stf::radius(0)) || !std::isfinite(radius)) return false;
        fitting = everywhere_;
        fitting.radius = radius;
    } else {
        const Samplers& shells = samplers_[0];
        const int number = Stf::largest(radius, shells.size());
        if (number < 0) return false;
        fitting = everywhere_;
        choose(shells, static_cast<size_t>(number), radius, u, fitting);
    }
    fitting.length = std::min(clear, fitting.radius / fitting.sigma_t);
    return true;
}

bool MediumShells::fit_in_grid(const V3d& place, double clear, double u, FittingShell& fitting) const
{
    const bool diffuses = form_ == StfForm::diffusion;
    const size_t count = diffuses ? 1 << 10 : samplers_[0].size();
    SameBall ball;
    if (!fit_ball(*grid_, place, clear, count, ball)) return false;
    const MediumMean& mean = ball.mean;
    const double sigma_t = mean.sigma_t, g = mean.g, radius = ball.length * sigma_t;
    fitting.sigma_t = sigma_t;
    fitting.albedo = mean.albedo;
    if (diffuses) {
        fitting.phase = PhaseFunction(g);
        fitting.radius = radius;
    } else {
        const auto above =
            std::ranges::upper_bound(stfs_, g, {}, [](const auto& stf) { return stf->phase.mean_cosine(); });
        size_t of = above == stfs_.begin() ? 0 : static_cast<size_t>(above - stfs_.begin()) - 1;
        if (above != stfs_.begin() && above != stfs_.end()) {
            const double g0 = stfs_[of]->phase.mean_cosine(), part = (g - g0) / ((*above)->phase.mean_cosine() - g0);
            if (u < part) ++of;
            u = u < part ? u / part : (u - part) / (1 - part); // rescaled to (0, 1), to be used again
        }
        fitting.phase = stfs_[of]->phase;
        const double brightest = max_component(fitting.albedo);
        size_t albedo = static_cast<size_t>(std::ranges::lower_bound(albedos_, brightest) - albedos_.begin());
        albedo = std::min(albedo, albedos_.size() - 1);
        fitting.sampled_albedo = albedos_[albedo];
        choose(samplers_[of * albedos_.size() + albedo], ball.number, radius, u, fitting);
    }
    fitting.length = std::min(ball.length, fitting.radius / sigma_t);
    return true;
}

} // namespace scree
