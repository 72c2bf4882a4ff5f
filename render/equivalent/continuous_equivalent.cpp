#include "render/equivalent/continuous_equivalent.h"

#include "render/equivalent/decay_constant.h"

#include <fmt/format.h>

#include <stdexcept>

namespace scree {

namespace {

constexpr double least_g = -0.95, most_g = 0.9999, least_albedo = 1e-3;

void match(ContinuousEquivalent& medium, double diffusivity, double transport_length)
{
    double g = 1 - diffusivity / (transport_length * transport_length);
    if (!(g >= least_g && g <= most_g)) {
        medium.doubt = fmt::format("no medium has diffusivity {:.3g} and transport length {:.3g}: the asymmetry g "
                                   "would be {:.3g}, {:.3g} is used",
                                   diffusivity, transport_length, g, std::clamp(g, least_g, most_g));
        g = std::clamp(g, least_g, most_g);
    }
    medium.g = g;
    medium.sigma_t = 1 / (transport_length * (1 - g));
}

void match_decay(ContinuousEquivalent& medium, const PackingWalk& walk)
{
    // The reflectance of a half-space depends on albedo and g alone. So the brightest channel keeps its albedo, and
    // sigma_t is chosen to give it the decay of the packing (if it decays at all). The other channels get their decay
    // by changed albedos.
    const MixtureMoments& moments = medium.moments;
    const int brightest = moments.albedo.x >= moments.albedo.y ? (moments.albedo.x >= moments.albedo.z ? 0 : 2)
                                                               : (moments.albedo.y >= moments.albedo.z ? 1 : 2);
    const double wanted = walk.decay[static_cast<size_t>(brightest)].kappa.value;
    if (const double kappa = decay_constant(moments.albedo[brightest], medium.g); wanted > 0 && kappa > 0)
        medium.sigma_t = wanted / kappa;
    for (int c = 0; c < 3; ++c) {
        const double kappa = walk.decay[static_cast<size_t>(c)].kappa.value / medium.sigma_t;
        if (!(kappa > 0)) continue; // no loss in this channel
        medium.albedo[c] = albedo_of_decay(std::min(kappa, 1.0), medium.g);
        if (medium.albedo[c] < least_albedo) {
            medium.doubt =
                fmt::format("light decays by exp(-{:.3g}) per mean free path, which is too fast for any albedo", kappa);
            medium.albedo[c] = least_albedo;
        }
    }
}

} // namespace

ContinuousEquivalent continuous_equivalent(const MixtureMoments& moments, EquivalentForm form, const PackingWalk* walk)
{
    ContinuousEquivalent medium;
    medium.form = form;
    medium.moments = moments;
    medium.albedo = moments.albedo;
    switch (form) {
    case EquivalentForm::plain:
        medium.sigma_t = 1 / moments.flight;
        medium.g = moments.g;
        break;
    case EquivalentForm::formula: match(medium, moments.diffusivity(), moments.transport_length()); break;
    case EquivalentForm::walk:
    case EquivalentForm::decay:
        if (!walk) throw std::invalid_argument("this form of the equivalent medium needs a walk in the packing");
        match(medium, walk->diffusivity.value, walk->transport_length.value);
        if (form == EquivalentForm::decay) match_decay(medium, *walk);
        break;
    }
    medium.transport_length = 1 / (medium.sigma_t * (1 - medium.g));
    medium.diffusivity = medium.transport_length / medium.sigma_t;
    for (int c = 0; c < 3; ++c) medium.decay[c] = medium.sigma_t * decay_constant(medium.albedo[c], medium.g);
    return medium;
}

} // namespace scree
