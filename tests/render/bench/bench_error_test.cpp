// Halves separate bias from noise: synthetic pictures whose truth, bias and noise are known.

#include "render/bench/error_estimate.h"
#include "render/film/relative_error.h"
#include "tests/builders/statistics.h"

#include <gmock/gmock.h>

#include <random>

namespace scree {
namespace {

constexpr int width = 48, height = 40;
constexpr double repeats = 200;

/// Colours between dark and bright, with an edge and a black corner.
std::vector<V3d> truth()
{
    std::vector<V3d> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double u = double(x) / width, v = double(y) / height;
            pixels.push_back(u < 0.1 && v < 0.1 ? V3d(0) : V3d(0.1 + u, 0.3 + 0.5 * v, x > 20 ? 0.9 : 0.2));
        }
    return pixels;
}

/// Noise of mean 0 and variance 1: if `skewed`, with a long tail above, as paths have it.
struct Noise {
    std::mt19937_64 random;
    bool skewed = false;
    double operator()()
    {
        if (skewed) return std::exponential_distribution<double>(1)(random) - 1;
        return std::normal_distribution<double>()(random);
    }
};

/// A picture of two halves: each pixel of the whole has noise of `deviation` times the truth, and the whole is `factor`
/// times as bright as it should be.
HalfPictures picture_of(double factor, double deviation, Noise& noise)
{
    HalfPictures picture;
    picture.width = width;
    picture.height = height;
    for (const V3d& t : truth()) {
        for (std::vector<V3d>* half : {&picture.a, &picture.b}) {
            half->push_back(factor * t * (V3d(1) + deviation * std::sqrt(2.0) * V3d(noise(), noise(), noise())));
        }
    }
    return picture;
}

/// The squared error that the estimators measure when every pixel is off by the part `deviation` of its truth.
double relative_square(double deviation)
{
    HalfPictures exact{width, height, truth(), truth(), {}};
    const RelativeError relative(mean_radiance(exact));
    double sum = 0;
    for (const V3d& t : exact.a) sum += relative.of(deviation * deviation * t.dot(t), t);
    return sum / static_cast<double>(exact.size());
}

TEST(ErrorEstimate, FindsTheNoiseOfBothAndTheirErrorApart)
{
    Estimate noise, reference_noise, error;
    Noise of{std::mt19937_64(1)};
    for (int k = 0; k < repeats; ++k) {
        const ErrorEstimate e = estimate_error(picture_of(1, 0.2, of), picture_of(1, 0.05, of));
        noise.add(e.noise.value);
        reference_noise.add(e.reference_noise.value);
        error.add(e.squared_error.value);
    }
    // The reference's own noise changes the divisor of the error by at most about the square of this noise.
    EXPECT_NEAR(noise.mean(), relative_square(0.2), 4 * noise.standard_error() + 0.02 * relative_square(0.2));
    EXPECT_NEAR(reference_noise.mean(), relative_square(0.05),
                4 * reference_noise.standard_error() + 0.02 * relative_square(0.05));
    EXPECT_NEAR(error.mean(), relative_square(0.2), 4 * error.standard_error() + 0.02 * relative_square(0.2));
}

/// Noise like that of caustics: nearly always a little too dark, and rarely far too bright.
struct Fireflies {
    std::mt19937_64 random;
    double operator()() { return std::bernoulli_distribution(0.005)(random) ? 14 : -0.07; }
};

// If errors were relative to the pixel itself, fireflies of the reference would weigh less than their absence, and the
// squared bias would be about 0.0012.
TEST(ErrorEstimate, AddsUpWithFirefliesInTheReference)
{
    Estimate bias, gap;
    Fireflies of{std::mt19937_64(7)};
    Noise quiet{std::mt19937_64(9)};
    for (int k = 0; k < repeats; ++k) {
        HalfPictures reference{width, height, {}, {}, {}};
        for (const V3d& t : truth()) {
            for (std::vector<V3d>* half : {&reference.a, &reference.b}) half->push_back(t * (1 + 0.5 * of()));
        }
        const ErrorEstimate e = estimate_error(picture_of(1, 0.02, quiet), reference);
        bias.add(e.squared_bias.value);
        gap.add(e.squared_error.value - e.noise.value);
        EXPECT_NEAR(e.squared_error.value, e.noise.value + e.squared_bias.value,
                    1e-12); // halves of equal share: exactly
    }
    EXPECT_LT(std::abs(bias.z(0)), 4);
    EXPECT_LT(std::abs(gap.z(0)), 4);
    EXPECT_LT(bias.standard_error(), 0.0006);
}

TEST(ErrorEstimate, KnowsItsStandardErrors)
{
    Noise of{std::mt19937_64(8)};
    Estimate value, part;
    double claimed = 0, claimed_of_part = 0;
    for (int k = 0; k < repeats; ++k) {
        std::vector<std::vector<V3d>> pictures;
        for (int s = 0; s < 2; ++s) pictures.push_back(picture_of(1, 0.1, of).a);
        const HalfPictures reference = picture_of(1, 0.1, of);
        const Measured m = squared_error(pictures, reference), p = part_to_error(pictures, reference);
        EXPECT_EQ(p.value, estimate_error(reference, reference).reference_noise.value / m.value);
        value.add(m.value);
        part.add(p.value);
        claimed += m.error / repeats;
        claimed_of_part += p.error / repeats;
    }
    for (const auto& [estimate, told] : {std::pair(&value, claimed), std::pair(&part, claimed_of_part)}) {
        const double scatter = estimate->standard_error() * std::sqrt(repeats);
        EXPECT_GT(told, 0.85 * scatter);
        EXPECT_LT(told, 2 * scatter);
    }
}

class Unbiased : public testing::TestWithParam<bool> {};

TEST_P(Unbiased, HasABiasOfNothingWithinItsInterval)
{
    Estimate bias;
    int covered = 0, claimed = 0;
    Noise of{std::mt19937_64(2), GetParam()};
    for (int k = 0; k < repeats; ++k) {
        const Measured b = estimate_error(picture_of(1, 0.3, of), picture_of(1, 0.1, of)).squared_bias;
        bias.add(b.value);
        covered += b.low() <= 0 && 0 <= b.high();
        claimed += b.is_above_zero();
    }
    EXPECT_LT(std::abs(bias.z(0)), 4);
    EXPECT_GE(covered, 0.89 * repeats); // 95 in 100, minus four standard deviations
    EXPECT_LE(claimed, 3);
}
INSTANTIATE_TEST_SUITE_P(Noises, Unbiased, testing::Bool());

TEST_P(Unbiased, IsFoundBiasedWhenItIs)
{
    // Power: the squared bias is known to about the variance of a half over the root of the number of pixels, here
    // 1e-3.
    Estimate bias, color;
    int claimed = 0, covered = 0;
    Noise of{std::mt19937_64(3), GetParam()};
    for (int k = 0; k < repeats; ++k) {
        const ErrorEstimate e = estimate_error(picture_of(1.08, 0.15, of), picture_of(1, 0.05, of));
        bias.add(e.squared_bias.value);
        color.add(e.color[1].value);
        claimed += e.squared_bias.is_above_zero();
        covered += std::abs(e.color[1].value - 0.08) < 1.96 * e.color[1].error;
    }
    // Errors are relative to the surroundings of a pixel, which differ from the pixel at the edge and the corner.
    EXPECT_NEAR(std::sqrt(bias.mean()), std::sqrt(relative_square(0.08)), 0.008);
    EXPECT_NEAR(color.mean(), 0.08, 4 * color.standard_error());
    EXPECT_GE(claimed, 0.95 * repeats);
    EXPECT_GE(covered, 0.89 * repeats);
}

TEST_P(Unbiased, ShowsSmallBiasesInSquares)
{
    int claimed = 0, wrong = 0;
    Estimate none;
    Noise of{std::mt19937_64(5), GetParam()};
    for (int k = 0; k < repeats; ++k) {
        claimed += estimate_error(picture_of(1.03, 0.15, of), picture_of(1, 0.05, of)).smooth_bias.is_above_zero();
        const Measured bias = estimate_error(picture_of(1, 0.15, of), picture_of(1, 0.05, of)).smooth_bias;
        wrong += bias.is_above_zero();
        none.add(bias.value);
    }
    EXPECT_GE(claimed, 0.9 * repeats);
    EXPECT_LE(wrong, 4);
    EXPECT_LT(std::abs(none.z(0)), 4);
}

TEST(ErrorEstimate, KnowsWhenTheReferenceIsNoBetter)
{
    Noise of{std::mt19937_64(4)};
    EXPECT_TRUE(estimate_error(picture_of(1, 0.02, of), picture_of(1, 0.1, of)).is_below_reference());
    EXPECT_FALSE(estimate_error(picture_of(1, 0.2, of), picture_of(1, 0.1, of)).is_below_reference());
}

TEST(ErrorEstimate, ClaimsNoBiasAgainstAReferenceOfUnknownNoise)
{
    Noise of{std::mt19937_64(6)};
    HalfPictures reference = picture_of(1.2, 0.1, of);
    reference.b = reference.a;
    reference.halved = false;
    const ErrorEstimate e = estimate_error(picture_of(1, 0.1, of), reference);
    EXPECT_FALSE(e.squared_bias.is_above_zero());
    EXPECT_FALSE(std::isfinite(e.squared_bias.error));
    EXPECT_FALSE(std::isfinite(e.squared_error.error));
    EXPECT_FALSE(std::isfinite(e.color[0].error));
    EXPECT_FALSE(e.is_below_reference());
}

TEST(HalfPictures, WeighsHalvesByTheirSamples)
{
    std::vector<Film> films(3, Film(1, 1, 0, 0, 1, 1));
    for (size_t f = 0; f < 3; ++f)
        for (size_t s = 0; s <= f; ++s) films[f].at(0, 0).add(Color(static_cast<float>(f)), {});
    const HalfPictures picture = make_halves(films); // a: 0, 2, 2, 2; b: 1, 1
    EXPECT_DOUBLE_EQ(picture.a[0].x, 1.5);
    EXPECT_DOUBLE_EQ(picture.b[0].x, 1);
    EXPECT_DOUBLE_EQ(picture.share, 4.0 / 6);
    EXPECT_DOUBLE_EQ(picture.whole(0).x, 8.0 / 6);
}

} // namespace
} // namespace scree
