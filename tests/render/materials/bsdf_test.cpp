// Every BSDF's sampler against its density, and the rough ones against their own evaluation: the directions that a
// microsurface walk draws must be distributed as its estimator says, and no energy may be lost.

#include "base/warp.h"
#include "render/materials/bsdf.h"
#include "tests/builders/scenes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr int bands = 16, sectors = 16; // of cos theta over -1..1 and of azimuth

size_t cell_of(const V3d& w)
{
    const int band = std::min(bands - 1, static_cast<int>((w.z + 1) / 2 * bands));
    const double phi = std::atan2(w.y, w.x) / (2 * pi) + 0.5;
    const int sector = std::min(sectors - 1, static_cast<int>(phi * sectors));
    return static_cast<size_t>(band * sectors + sector);
}

V3d direction(double cosine) { return {std::sqrt(1 - cosine * cosine), 0, cosine}; }

Material conductor(double alpha)
{
    Material material;
    material.kind = MaterialKind::conductor;
    material.eta = Color(0.2f);
    material.k = Color(3.9f);
    material.alpha = alpha;
    return material;
}

TEST(Lambert, SamplesItsDensity)
{
    const Material material = lambert(0.7f);
    for (const double cosine : {0.9, -0.4}) {
        const V3d wo = direction(cosine);
        const int n = 200000;
        std::vector<double> observed(bands * sectors), expected(bands * sectors);
        Sampler sampler(1, 0, 0, 0);
        for (int i = 0; i < n; ++i) {
            const BsdfSample s = sample_bsdf(material, wo, sampler);
            ASSERT_TRUE(s.valid);
            ASSERT_NEAR(s.pdf, pdf_bsdf(material, wo, s.wi), 1e-12);
            observed[cell_of(s.wi)] += 1;
        }
        for (int band = 0; band < bands; ++band) { // cos / pi integrates to the difference of cos^2 over a band
            const double lo = -1 + 2.0 * band / bands, hi = lo + 2.0 / bands;
            const double mass = cosine > 0
                                    ? std::max(0.0, hi) * std::max(0.0, hi) - std::max(0.0, lo) * std::max(0.0, lo)
                                    : std::min(0.0, lo) * std::min(0.0, lo) - std::min(0.0, hi) * std::min(0.0, hi);
            for (int s = 0; s < sectors; ++s) expected[static_cast<size_t>(band * sectors + s)] = n * mass / sectors;
        }
        const ChiSquare test = chi_square(observed, expected);
        EXPECT_GT(test.p_value, 1e-4) << test.text;
    }
}

struct RoughCase {
    const char* name;
    Material material;
    double cosine;
};

std::vector<RoughCase> rough_cases()
{
    std::vector<RoughCase> cases;
    for (const double alpha : {0.3, 0.5, 0.9}) {
        for (const double cosine : {0.95, 0.5, 0.1}) {
            cases.push_back({"dielectric 1.5", dielectric(1.5, alpha), cosine});
            cases.push_back({"dielectric 1.5 from inside", dielectric(1.5, alpha), -cosine});
            cases.push_back({"conductor", conductor(alpha), cosine});
        }
    }
    return cases;
}

// The walk's sampler (weighted) against its estimator over the sphere: two-sample chi-square, 256 cells, 150,000 draws
// each. It finds an error of 10 % in a single cell of 1,000 counts, or of 1 % in the whole.
TEST(Rough, SamplesWhatItEvaluates)
{
    const auto cases = rough_cases();
    const double level = sidak(0.001, static_cast<int>(cases.size()));
    for (const RoughCase& c : cases) {
        const V3d wo = direction(c.cosine);
        const int n = 150000;
        std::vector<double> drawn(bands * sectors), evaluated(bands * sectors), variance(bands * sectors);
        Sampler sampler(7, 1, 2, 3);
        for (int i = 0; i < n; ++i) {
            const BsdfSample s = sample_bsdf(c.material, wo, sampler);
            ASSERT_TRUE(s.valid);
            // A weight below 1 is turned into a count by chance.
            if (sampler.next() < s.weight.x) drawn[cell_of(s.wi)] += 1;
        }
        // Stratified over the cells: each gets the same number of uniform directions, so that its integral has a small
        // error.
        const int per_cell = 5000;
        for (int band = 0; band < bands; ++band) {
            for (int sector = 0; sector < sectors; ++sector) {
                Estimate mean;
                for (int i = 0; i < per_cell; ++i) {
                    const double z = -1 + 2 * (band + sampler.next()) / bands;
                    const double phi = 2 * pi * ((sector + sampler.next()) / sectors - 0.5);
                    const double r = std::sqrt(1 - z * z);
                    mean.add(eval_bsdf(c.material, wo, {r * std::cos(phi), r * std::sin(phi), z}, sampler).x);
                }
                const double area = 4 * pi / (bands * sectors) * n;
                const auto cell = static_cast<size_t>(band * sectors + sector);
                evaluated[cell] = mean.mean() * area;
                variance[cell] = mean.standard_error() * mean.standard_error() * area * area;
            }
        }
        const ChiSquare test = chi_square_two(drawn, evaluated, variance);
        EXPECT_GT(test.p_value, level) << c.name << " alpha " << c.material.alpha << " cosine " << c.cosine << ": "
                                       << test.text;
    }
}

// Narrow lobes: within a cell the estimates are too uneven for the normal errors that chi-square needs, but the share
// of each hemisphere can be compared with their integral. The standard error is below 0.015 of the whole.
TEST(Rough, NarrowLobesShareTheHemispheresAsTheyEvaluate)
{
    Sampler sampler(8, 0, 0, 0);
    for (const double cosine : {0.5, -0.5, -0.95}) {
        const Material material = dielectric(1.5, 0.15);
        const V3d wo = direction(cosine);
        Estimate drawn, evaluated;
        for (int i = 0; i < 200000; ++i) drawn.add(sample_bsdf(material, wo, sampler).wi.z > 0);
        for (int i = 0; i < 1000000; ++i) {
            const double u1 = sampler.next(), u2 = sampler.next();
            const V3d wi = sample_sphere(u1, u2);
            evaluated.add(wi.z > 0 ? 4 * pi * eval_bsdf(material, wo, wi, sampler).x : 0);
        }
        const double error = std::hypot(drawn.standard_error(), evaluated.standard_error());
        EXPECT_LT(std::abs(drawn.mean() - evaluated.mean()), 4 * error)
            << drawn.mean() << " against " << evaluated.mean();
        EXPECT_LT(error, 0.015);
    }
}

// f(a, b) cos b and f(b, a) cos a: for conductors f is symmetric; for dielectrics f / n^2 of the far side is.
TEST(Rough, IsReciprocal)
{
    Sampler sampler(3, 0, 0, 0);
    const int n = 400000;
    for (const Material& material : {dielectric(1.5, 0.5), conductor(0.5)}) {
        for (const auto& [a, b] : {std::pair{direction(0.8), V3d(-0.5, 0.3, std::sqrt(1 - 0.34))},
                                   std::pair{direction(0.6), V3d(-0.3, 0.2, -std::sqrt(1 - 0.13))}}) {
            if (b.z < 0 && !material.transmits()) continue;
            Estimate forward, backward;
            for (int i = 0; i < n; ++i) {
                forward.add(eval_bsdf(material, a, b, sampler).x / std::abs(b.z));
                backward.add(eval_bsdf(material, b, a, sampler).x / std::abs(a.z));
            }
            // Basic radiance: f counts densities of direction, which refraction into the denser side compresses by n^2.
            const double n2 = a.z * b.z < 0 ? material.ior * material.ior : 1;
            const double difference = forward.mean() - n2 * backward.mean();
            const double error = std::hypot(forward.standard_error(), n2 * backward.standard_error());
            EXPECT_LT(std::abs(difference), 4 * error) << forward.mean() << " against " << n2 * backward.mean();
            EXPECT_LT(error, 0.02 * forward.mean());
        }
    }
}

TEST(Rough, DielectricWeightsAreOne)
{
    Sampler sampler(5, 0, 0, 0);
    for (const double alpha : {0.01, 0.2, 1.0}) {
        for (const double cosine : {1.0, 0.3, 0.01, -0.01, -0.9}) {
            for (int i = 0; i < 2000; ++i) {
                const BsdfSample s = sample_bsdf(dielectric(1.5, alpha), direction(cosine), sampler);
                ASSERT_TRUE(s.valid);
                ASSERT_EQ(s.weight.x, 1.0f);
                ASSERT_NEAR(s.wi.length(), 1, 1e-9);
            }
        }
    }
}

// A conductor that reflects everything loses nothing at any roughness.
TEST(Rough, WhiteConductorLosesNothing)
{
    Material white = conductor(0.8);
    white.eta = Color(0);
    white.k = Color(1);
    Sampler sampler(6, 0, 0, 0);
    for (int i = 0; i < 20000; ++i) {
        const BsdfSample s = sample_bsdf(white, direction(0.2), sampler);
        ASSERT_TRUE(s.valid);
        ASSERT_NEAR(s.weight.x, 1, 1e-5);
        ASSERT_GT(s.wi.z, 0);
    }
}

TEST(Smooth, ReflectsByFresnelAndRefractsBySnell)
{
    const Material glass = dielectric(1.5);
    const V3d wo = direction(0.6);
    Sampler sampler(2, 0, 0, 0);
    Estimate reflected;
    for (int i = 0; i < 200000; ++i) {
        const BsdfSample s = sample_bsdf(glass, wo, sampler);
        ASSERT_TRUE(s.valid);
        reflected.add(s.wi.z > 0);
        if (s.wi.z < 0) {
            ASSERT_NEAR(std::hypot(s.wi.x, s.wi.y), 0.8 / 1.5, 1e-12);
        }
    }
    // Fresnel's formulas written with n cos_t = sqrt(n^2 - sin^2).
    const double root = std::sqrt(2.25 - 0.64), rs = (0.6 - root) / (0.6 + root),
                 rp = (2.25 * 0.6 - root) / (2.25 * 0.6 + root);
    EXPECT_LT(std::abs(reflected.z(0.5 * (rs * rs + rp * rp))), 4);
}

} // namespace
} // namespace scree
