#include "render/stf/medium_shells.h"

namespace scree {

MediumShells::MediumShells(std::shared_ptr<const Stf> stf, const HomogeneousMedium& medium, size_t count, StfForm form)
    : stf_(std::move(stf)), form_(form), sigma_t_(medium.sigma_t().x), albedo_(medium.albedo()), phase_table_(medium.phase_table()), phase_(medium.phase()), sampled_albedo_(max_component(albedo_))
{
    for (size_t i = 0; i < std::min(count, stf_->shells.size()); ++i) shells_.emplace_back(stf_->shells[i], sampled_albedo_);
}

bool MediumShells::fit(double clear, double u, FittingShell& fitting) const
{
    double radius = clear * sigma_t_;
    fitting.shell = nullptr;
    if (form_ == StfForm::diffusion) {
        if (!(radius >= Stf::radius(0)) || !std::isfinite(radius)) return false;
    } else {
        const int k = Stf::largest(radius, shells_.size());
        if (k < 0) return false;
        auto number = static_cast<size_t>(k);
        if (form_ == StfForm::interpolated && number + 1 < shells_.size()) {
            if (u < std::log2(radius / Stf::radius(number)) * Stf::steps_per_octave) ++number;
        } else {
            radius = Stf::radius(number);
        }
        fitting.shell = &shells_[number];
    }
    fitting.radius = radius;
    fitting.length = std::min(clear, radius / sigma_t_);
    fitting.sigma_t = sigma_t_;
    fitting.albedo = albedo_;
    fitting.sampled_albedo = sampled_albedo_;
    fitting.phase = phase_;
    return true;
}

uint64_t MediumShells::bytes() const
{
    uint64_t records = 0;
    for (const StfShell& shell : stf_->shells) records += shell.exits.size() + shell.events.size();
    return stf_->bytes() + 8 * records; // and the alias tables
}

} // namespace scree
