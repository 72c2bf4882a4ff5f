// The numbers of the equivalent medium of a packing, against simulated walks with independent flights.

#include "base/error.h"
#include "base/warp.h"
#include "render/equivalent/continuous_equivalent.h"
#include "render/equivalent/decay_constant.h"
#include "render/gsdf/encounter.h"
#include "render/gsdf/gsdf_builder.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

struct Grains {
    Material material;
    std::shared_ptr<const Gsdf> gsdf;
};

std::vector<Grains>& all_grains_once()
{
    static std::vector<Grains> grains = [] {
        static const EmbreeDevice device;
        static const Exemplar body(device, cube(), "cube");
        Material tea = dielectric(1.5);
        tea.absorption = Color(0.05f, 0.2f, 0);
        const auto glass = build_gsdf({nullptr, dielectric(1.5)}, {0.08});
        return std::vector<Grains>{{lambert(1), build_gsdf({nullptr, lambert(1)}, {0.08})},
                                   {dielectric(1.5), glass},
                                   {tea, glass},
                                   {lambert(0.7f), build_gsdf({&body, lambert(1)}, {0.08})}};
    }();
    return grains;
}

struct Walked {
    Estimate l, m2, g, a, b, delta2, diffusivity, transport, weight, weighted_cosine;
};

/// Walks with independent flights among grains of the shares: exponential in the voids, each encounter like that with a
/// proxy.
Walked walk_independently(std::span<const GrainShare> shares, double void_flight, int walks, int events, int window)
{
    std::vector<double> cumulated;
    double sum = 0;
    for (const GrainShare& share : shares) cumulated.push_back(sum += share.number * share.radius * share.radius);
    Walked result;
    for (int walk = 0; walk < walks; ++walk) {
        Sampler sampler(5, static_cast<uint32_t>(walk), 0, 0);
        std::vector<V3d> starts{V3d(0)}, directions;
        const double u1 = sampler.next(), u2 = sampler.next();
        V3d w = sample_sphere(u1, u2), p(0);
        double l = 0, m2 = 0, g = 0, a = 0, b = 0, delta2 = 0, weight = 0, weighted_cosine = 0;
        for (int event = 0; event < events; ++event) {
            directions.push_back(w);
            double s = -void_flight * std::log(sampler.next());
            while (true) {
                const double which = sum * sampler.next();
                const auto i =
                    std::min(shares.size() - 1,
                             static_cast<size_t>(std::ranges::upper_bound(cumulated, which) - cumulated.begin()));
                const GrainShare& share = shares[i];
                const Gsdf& gsdf = *share.gsdf;
                const double q = sampler.next();
                if (sampler.next() < gsdf.alpha0(q)) {
                    s += 2 * share.radius * std::sqrt(1 - q) - void_flight * std::log(sampler.next());
                    continue;
                }
                const double phi = 2 * pi * sampler.next();
                const Frame frame(w);
                const V3d entry =
                    frame.to_world({std::sqrt(q) * std::cos(phi), std::sqrt(q) * std::sin(phi), -std::sqrt(1 - q)});
                const Encounter encounter(entry, w);
                const uint32_t stratum = Gsdf::stratum(q, sampler.next()),
                               cell = gsdf.sample_cell(stratum, sampler.next());
                const uint32_t number = gsdf.pick(stratum, cell, sampler.next());
                const V3d exit = encounter.to_world(gsdf.record(number).point.unpack()),
                          out = encounter.to_world(gsdf.record(number).direction.unpack());
                const V3d delta = share.radius * (exit - entry);
                const double kept = gsdf.weight(number, share.material, share.radius).x;
                l += s;
                m2 += s * s;
                g += w.dot(out);
                a += delta.dot(w);
                b += delta.dot(out);
                delta2 += delta.length2();
                weight += kept;
                weighted_cosine += kept * w.dot(out);
                p += s * w + delta;
                w = out.normalized();
                break;
            }
            starts.push_back(p);
        }
        double diffusivity = 0, transport = 0;
        const int windows = events - window;
        for (int i = 0; i < windows; ++i) {
            const V3d step = starts[static_cast<size_t>(i) + 1] - starts[static_cast<size_t>(i)],
                      way = starts[static_cast<size_t>(i + window)] - starts[static_cast<size_t>(i)];
            diffusivity += (0.5 * step.length2() + step.dot(way - step)) / windows;
            transport += way.dot(directions[static_cast<size_t>(i)]) / windows;
        }
        const std::pair<Estimate*, double> sums[] = {
            {&result.l, l},           {&result.m2, m2},
            {&result.g, g},           {&result.a, a},
            {&result.b, b},           {&result.delta2, delta2},
            {&result.weight, weight}, {&result.weighted_cosine, weighted_cosine}};
        for (const auto& [estimate, value] : sums) estimate->add(value / events);
        result.diffusivity.add(diffusivity);
        result.transport.add(transport);
    }
    return result;
}

void expect_agreement(std::span<const GrainShare> shares, double fraction, const std::string& what)
{
    const MixtureMoments mixture = mixture_moments(shares, fraction);
    const Walked walked = walk_independently(shares, mixture.void_flight, 6000, 120, 40);
    const std::tuple<const char*, const Estimate*, double> rows[] = {
        {"l", &walked.l, mixture.flight},
        {"m2", &walked.m2, mixture.flight2},
        {"g", &walked.g, mixture.g},
        {"a", &walked.a, mixture.along_in},
        {"b", &walked.b, mixture.along_out},
        {"delta^2", &walked.delta2, mixture.delta2},
        {"w", &walked.weight, mixture.albedo.x},
        {"w cos", &walked.weighted_cosine, mixture.weighted_cosine.x},
        {"D", &walked.diffusivity, mixture.diffusivity()},
        {"l*", &walked.transport, mixture.transport_length()}};
    for (const auto& [name, estimate, truth] : rows) {
        // After a window of 40 scatterings 0.66^40 of the memory of light is left: nothing.
        EXPECT_LT(std::abs(estimate->mean() - truth), 4 * estimate->standard_error() + 1e-6 * std::abs(truth))
            << what << " f " << fraction << " " << name;
        std::printf("%-14s f %.2f %-8s formula %9.5f walked %9.5f +- %.5f\n", what.c_str(), fraction, name, truth,
                    estimate->mean(), estimate->standard_error());
    }
}

TEST(ContinuousEquivalent, FormulaIsThatOfIndependentFlights)
{
    const char* names[] = {"white", "glass", "tea", "cube"};
    int i = 0;
    for (const Grains& grains : all_grains_once()) {
        const GrainShare share{grains.gsdf.get(), nullptr, grains.material, 1, 1};
        for (const double fraction : {0.1, 0.6}) expect_agreement({&share, 1}, fraction, names[i]);
        ++i;
    }
}

TEST(ContinuousEquivalent, FormulaHoldsForMixturesOfTypesAndSizes)
{
    const auto& grains = all_grains_once();
    const GrainShare shares[] = {{grains[2].gsdf.get(), nullptr, grains[2].material, 1, 1},
                                 {grains[3].gsdf.get(), nullptr, grains[3].material, 2, 0.5},
                                 {grains[0].gsdf.get(), nullptr, lambert(0.9f), 0.5, 2}};
    expect_agreement(shares, 0.4, "mixture");
}

TEST(ContinuousEquivalent, VoidFlightIsTheMeanChordOfTheVoids)
{
    const auto& white = all_grains_once()[0];
    const GrainShare shares[] = {{white.gsdf.get(), nullptr, white.material, 1, 3},
                                 {white.gsdf.get(), nullptr, white.material, 2, 1}};
    const double f = 0.55, r2 = (3 + 4) / 4.0, r3 = (3 + 8) / 4.0;
    EXPECT_DOUBLE_EQ(mixture_moments(shares, f).void_flight, 4 * (1 - f) * r3 / (3 * f * r2));
}

// A reciprocal grain scatters backwards along a path as it does forwards.
TEST(ContinuousEquivalent, WaysInAndOutAreAlike)
{
    for (const Grains& grains : all_grains_once()) {
        const GrainMoments moments = grain_moments(*grains.gsdf);
        std::printf("g %.5f a %.5f b %.5f delta2 %.5f alpha0 %.5f\n", moments.g, moments.along_in, moments.along_out,
                    moments.delta2, moments.alpha0);
        // Each is a mean over the stored records of 32 * 2048 cells; their standard deviation is below 1.
        EXPECT_NEAR(moments.along_in, moments.along_out,
                    4 / std::sqrt(static_cast<double>(grains.gsdf->data().records.size())));
    }
}

TEST(ContinuousEquivalent, MeanCosineIsThatOfASphere)
{
    const auto& grains = all_grains_once();
    EXPECT_NEAR(grain_moments(*grains[0].gsdf).g, -4.0 / 9, 0.005);
    EXPECT_NEAR(grain_moments(*grains[1].gsdf).g, 0.65009, 0.005);
}

TEST(ContinuousEquivalent, RefusesWhatIsNoPacking)
{
    const auto& white = all_grains_once()[0];
    const GrainShare share{white.gsdf.get(), nullptr, white.material, 1, 1};
    for (const double f : {0.0, 1.0, -1.0, std::nan("")}) EXPECT_THROW(mixture_moments({&share, 1}, f), InputError);
    EXPECT_THROW(mixture_moments({}, 0.5), InputError);
    const GrainShare flat{white.gsdf.get(), nullptr, white.material, 0, 1};
    EXPECT_THROW(mixture_moments({&flat, 1}, 0.5), InputError);
}

TEST(ContinuousEquivalent, FormsKeepWhatTheyPromise)
{
    const Grains& tea = all_grains_once()[2];
    const GrainShare share{tea.gsdf.get(), nullptr, tea.material, 1, 1};
    const MixtureMoments mixture = mixture_moments({&share, 1}, 0.5);
    const auto plain = continuous_equivalent(mixture, EquivalentForm::plain),
               formula = continuous_equivalent(mixture, EquivalentForm::formula);
    EXPECT_DOUBLE_EQ(plain.sigma_t, 1 / mixture.flight);
    EXPECT_DOUBLE_EQ(plain.g, mixture.g);
    EXPECT_NEAR(formula.diffusivity, mixture.diffusivity(), 1e-12 * mixture.diffusivity());
    EXPECT_NEAR(formula.transport_length, mixture.transport_length(), 1e-12 * mixture.transport_length());
    EXPECT_EQ(formula.albedo, mixture.albedo);
    EXPECT_EQ(formula.albedo.z, 1); // blue is not absorbed: exactly 1
    EXPECT_EQ(formula.decay.z, 0);
    EXPECT_THROW(continuous_equivalent(mixture, EquivalentForm::decay), std::invalid_argument);
}

TEST(ContinuousEquivalent, SaysWhatIsOutOfReach)
{
    const Grains& tea = all_grains_once()[2];
    const GrainShare share{tea.gsdf.get(), nullptr, tea.material, 1, 1};
    const MixtureMoments mixture = mixture_moments({&share, 1}, 0.5);
    PackingWalk walk;
    walk.diffusivity = {1, 0.01};
    walk.transport_length = {1, 0.01};
    EXPECT_EQ(continuous_equivalent(mixture, EquivalentForm::decay, &walk).doubt, "");
    walk.decay[1].kappa = {2, 0.1}; // the mean free path is 1
    const auto dark = continuous_equivalent(mixture, EquivalentForm::decay, &walk);
    EXPECT_NE(dark.doubt, "");
    EXPECT_GT(dark.albedo.y, 0);
    EXPECT_LT(dark.albedo.y, 0.01);
    walk.diffusivity.value = 3; // g would be -2
    const auto backwards = continuous_equivalent(mixture, EquivalentForm::walk, &walk);
    EXPECT_NE(backwards.doubt, "");
    EXPECT_GT(backwards.g, -1);
    EXPECT_NEAR(backwards.transport_length, 1, 1e-12);
}

TEST(DecayConstant, IsTheClosedFormForIsotropicScattering)
{
    for (const double albedo : {0.3, 0.5, 0.8, 0.95, 0.999, 1 - 1e-7}) {
        const double kappa = decay_constant(albedo, 0);
        EXPECT_NEAR(albedo * std::atanh(kappa) / kappa, 1, 1e-9) << albedo;
        EXPECT_NEAR((1 - albedo_of_decay(kappa, 0)) / (1 - albedo), 1, 1e-8) << albedo;
    }
    EXPECT_EQ(decay_constant(1, 0.5), 0);
    EXPECT_NEAR(decay_constant(0, 0), 1, 1e-6);
    EXPECT_EQ(albedo_of_decay(0, 0.3), 1);
    EXPECT_EQ(albedo_of_decay(1, 0.3), 0);
}

TEST(DecayConstant, IsThatOfDiffusionNearAlbedoOne)
{
    for (const double g : {-0.9, -0.4, 0.3, 0.75, 0.9, 0.99}) {
        for (const double loss : {1e-8, 1e-6}) {
            const double kappa = decay_constant(1 - loss, g), diffusion = std::sqrt(3 * loss * (1 - g));
            EXPECT_NEAR(kappa / diffusion, 1, 3 * loss / (1 - std::abs(g)) + 1e-7) << g << " " << loss;
        }
        for (const double albedo : {0.2, 0.6, 0.9, 0.99})
            EXPECT_NEAR(albedo_of_decay(decay_constant(albedo, g), g), albedo, 1e-6) << g;
    }
}

} // namespace
} // namespace scree
