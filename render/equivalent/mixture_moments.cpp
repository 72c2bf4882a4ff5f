#include "render/equivalent/mixture_moments.h"

#include "base/error.h"

#include <fmt/format.h>

namespace scree {

double MixtureMoments::diffusivity() const
{
    // A step is Y_i = s_i w_i + delta_i. The first term is <Y_i^2> / 2, the second is the correlation with all later
    // steps: the mean of Y_i . w_(i+1) is l g + b, and the mean of Y_j along w_(i+1) is (l + a) g^(j-i-1).
    return 0.5 * (flight2 + 2 * flight * along_in + delta2) + (flight * g + along_out) * transport_length();
}

MixtureMoments mixture_moments(std::span<const GrainShare> shares, double fraction)
{
    const std::string place = "continuous equivalent";
    if (!(fraction > 0 && fraction < 1))
        throw InputError(place, fmt::format("a pack rate of {:g}", fraction), "more than 0 and less than 1");
    MixtureMoments mixture;
    double r2 = 0, r3 = 0; // sums over grains
    double scattered = 0, passed = 0, chord = 0, chord2 = 0; // cross-sections, and chords weighted by them
    V3d lost(0);
    for (const GrainShare& share : shares) {
        if (!(share.number >= 0 && share.radius > 0 && std::isfinite(share.number * share.radius)))
            throw InputError(place, fmt::format("{:g} grains of radius {:g}", share.number, share.radius),
                             "a number of at least 0 and a positive radius");
        if (share.number == 0) continue;
        const GrainMoments moments = share.moments ? *share.moments : grain_moments(*share.gsdf);
        const GrainAlbedo albedo =
            share.albedo ? *share.albedo : grain_albedo(*share.gsdf, share.material, share.radius);
        const double r = share.radius, area = share.number * r * r, met = area * (1 - moments.alpha0),
                     missed = area * moments.alpha0;
        r2 += area;
        r3 += area * r;
        scattered += met;
        passed += missed;
        chord += missed * r * moments.pass_chord;
        chord2 += missed * r * r * moments.pass_chord2;
        mixture.g += met * moments.g;
        mixture.along_in += met * r * moments.along_in;
        mixture.along_out += met * r * moments.along_out;
        mixture.delta2 += met * r * r * moments.delta2;
        lost += met * (V3d(1) - albedo.weight);
        mixture.weighted_cosine += met * albedo.weighted_cosine;
        for (uint32_t i = 0; i < CosineTable::bins; ++i) mixture.phase.density[i] += met * moments.phase.density[i];
    }
    if (!(scattered > 0)) throw InputError(place, "no grains that scatter", "at least one");
    for (double* sum : {&mixture.g, &mixture.along_in, &mixture.along_out, &mixture.delta2}) *sum /= scattered;
    mixture.albedo = V3d(1) - lost / scattered;
    mixture.weighted_cosine /= scattered;
    for (double& density : mixture.phase.density) density /= scattered;
    if (passed > 0) {
        chord /= passed;
        chord2 /= passed;
    }
    const double l_v = 4 * (1 - fraction) * r3 / (3 * fraction * r2);
    // The number K of passes before a scattering is geometric, with mean `passes` and variance passes (1 + passes). The
    // flight is s_0 + the sum over K of (c_k + s_k). Its variance is var(s_0) + mean(K) var(c + s) + var(K) mean(c +
    // s)^2.
    const double passes = passed / scattered, step = chord + l_v;
    const double variance =
        l_v * l_v + passes * (chord2 - chord * chord + l_v * l_v) + passes * (1 + passes) * step * step;
    mixture.void_flight = l_v;
    mixture.flight = l_v + passes * step;
    mixture.flight2 = mixture.flight * mixture.flight + variance;
    return mixture;
}

} // namespace scree
