#include "render/media/homogeneous_medium.h"

namespace scree {

HomogeneousMedium::HomogeneousMedium(const Imath::V3d& sigma_t, const Weight& albedo, double g)
    : sigma_t_(sigma_t), albedo_(albedo), phase_(g)
{
}

HomogeneousMedium::HomogeneousMedium(const Imath::V3d& sigma_t, const Weight& albedo,
                                     std::shared_ptr<const PhaseTable> table)
    : sigma_t_(sigma_t), albedo_(albedo), table_(std::move(table)), phase_(table_.get())
{
}

MediumEvent HomogeneousMedium::event(double t0, double t1, SpectralState& state, Sampler& sampler) const
{
    const double sigma = sigma_t_[static_cast<int>(state.hero)];
    if (!(sigma > 0) && is_achromatic()) return {};
    const double t = sigma > 0 ? t0 + draw_optical_depth(sampler) / sigma : std::numeric_limits<double>::infinity();
    const bool scattered = t < t1;
    if (!is_achromatic()) {
        const double length = (scattered ? t : t1) - t0;
        Weight factor(1);
        for (int c = 0; c < 3; ++c) {
            if (sigma_t_[c] == sigma) continue;
            const double ratio = std::exp((sigma - sigma_t_[c]) * length) * (scattered ? sigma_t_[c] / sigma : 1);
            factor[c] = std::min(ratio, std::numeric_limits<double>::max());
        }
        state.multiply(factor);
    }
    return {scattered, t, albedo_, phase_};
}

Color HomogeneousMedium::transmittance(double length) const
{
    const auto of = [&](double sigma) { return sigma > 0 ? static_cast<Real>(std::exp(-sigma * length)) : Real(1); };
    if (is_achromatic()) return Color(of(sigma_t_.x));
    return {of(sigma_t_.x), of(sigma_t_.y), of(sigma_t_.z)};
}

} // namespace scree
