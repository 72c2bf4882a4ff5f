#include "mixtures/random_mixture.h"
#include "tests/builders/statistics.h"
#include "tests/mixtures/mixture_builders.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>

namespace scree {
namespace {

constexpr uint64_t million = 1'000'000;

RandomMixture random_mixture(const std::vector<double>& weights, uint64_t seed)
{
    std::vector<uint32_t> types(weights.size());
    std::iota(types.begin(), types.end(), 0u);
    return {types, weights, seed, 0, SphereIds()};
}

TEST(RandomMixture, FractionsByNumberFollowTheWeights)
{
    const std::vector<std::vector<double>> cases{{1, 1},
                                                 {0.3, 0.7},
                                                 {5, 3, 2},
                                                 {1e-3, 1},
                                                 {1, 0, 3},
                                                 std::vector<double>(40, 1),
                                                 {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}};
    const double level = sidak(1e-4, static_cast<int>(3 * cases.size()));
    for (const auto& weights : cases) {
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
        for (const uint64_t seed : {0, 1, 77}) {
            const RandomMixture mixture = random_mixture(weights, seed);
            std::vector<double> observed(weights.size(), 0), expected;
            for (const double w : weights) expected.push_back(w / sum * double(million));
            for (uint64_t i = 0; i < million; ++i) observed[mixture.type(i, {})] += 1;
            const ChiSquare result = chi_square(observed, expected);
            EXPECT_GT(result.p_value, level) << "seed " << seed << ", " << weights.size() << " types: " << result.text;
            for (size_t k = 0; k < weights.size(); ++k) EXPECT_TRUE(weights[k] > 0 || observed[k] == 0);
        }
    }
}

/// Chi-square test that the types from two mixtures of three equal weights are independent.
ChiSquare independence(const Mixture& first, uint64_t shift, const Mixture& second)
{
    std::vector<double> observed(9, 0), expected(9, double(million) / 9);
    for (uint64_t i = 0; i < million; ++i) observed[3 * first.type(i, {}) + second.type(i + shift, {})] += 1;
    return chi_square(observed, expected);
}

TEST(RandomMixture, NeighbouringIndicesAreIndependent)
{
    const std::vector<uint64_t> shifts{1, 2, 3, 4, 8, 16, 64, 256, 1024, 65536, uint64_t{1} << 32};
    const RandomMixture mixture = random_mixture({1, 1, 1}, 5);
    for (const uint64_t shift : shifts) {
        const ChiSquare result = independence(mixture, shift, mixture);
        EXPECT_GT(result.p_value, sidak(1e-4, int(shifts.size()))) << "shift " << shift << ": " << result.text;
    }
}

TEST(RandomMixture, NeighbouringSeedsAreIndependent)
{
    for (uint64_t seed = 0; seed < 12; ++seed) {
        const ChiSquare result = independence(random_mixture({1, 1, 1}, seed), 0, random_mixture({1, 1, 1}, seed + 1));
        EXPECT_GT(result.p_value, sidak(1e-4, 12)) << "seed " << seed << ": " << result.text;
    }
}

TEST(RandomMixture, EqualSeedsInsideABlendAreIndependent)
{
    const auto mixture =
        test::mixture_of(R"({"kind": "blend", "by": {"kind": "random", "types": ["m", "n"]}, "mixtures": {
        "m": {"kind": "random", "types": ["a", "b"]}, "n": {"kind": "random", "types": ["c", "d"]}}})",
                         nullptr);
    std::vector<double> observed(4, 0);
    for (uint64_t i = 0; i < million; ++i) observed[mixture->type(i, {})] += 1;
    const ChiSquare result = chi_square(observed, std::vector<double>(4, double(million) / 4));
    EXPECT_GT(result.p_value, 1e-4) << result.text;
}

TEST(RandomMixture, FollowsTheIdAndNotTheRow)
{
    ParticleFrame frame = test::random_spheres(1000, 10);
    const std::string json = R"({"kind": "random", "types": ["a", "b", "c"], "seed": 4})";
    const auto before = test::types_of(*test::mixture_of(json, &frame), frame);
    // Every second sphere has left.
    ParticleFrame rest;
    rest.has_ids = true;
    for (size_t i = 1; i < frame.size(); i += 2) {
        rest.position.push_back(frame.position[i]);
        rest.radius.push_back(frame.radius[i]);
        rest.type.push_back(frame.type[i]);
        rest.id.push_back(frame.id[i]);
    }
    const auto after = test::types_of(*test::mixture_of(json, &rest), rest);
    for (size_t i = 0; i < rest.size(); ++i) EXPECT_EQ(after[i], before[2 * i + 1]);
}

TEST(RandomMixture, WeightsMustMakeSense)
{
    EXPECT_THROW(random_mixture({0, 0}, 0), std::invalid_argument);
    EXPECT_THROW(random_mixture({1, -1}, 0), std::invalid_argument);
    EXPECT_THROW(random_mixture({1, std::nan("")}, 0), std::invalid_argument);
    EXPECT_THROW(random_mixture({1e308, 1e308}, 0), std::invalid_argument);
}

std::vector<double> volume_fractions(const ParticleFrame& frame, const std::vector<uint32_t>& types, size_t count)
{
    std::vector<double> volume(count, 0);
    double sum = 0;
    for (size_t i = 0; i < types.size(); ++i) {
        const double r = frame.radius[i];
        volume[types[i]] += r * r * r;
        sum += r * r * r;
    }
    for (double& v : volume) v /= sum;
    return volume;
}

TEST(RandomByVolume, FractionsAreRightOnAStronglyPolydisperseSet)
{
    for (const size_t count : {20000, 1000000}) {
        const ParticleFrame frame = test::random_spheres(count, 100, 1.0);
        for (const std::vector<double>& weights :
             {std::vector<double>{0.5, 0.5}, {0.9, 0.1}, {0.2, 0.3, 0.5}, {0.01, 0.99}, {0, 2, 1}}) {
            const auto chosen = choose_by_volume(frame.radius, SphereIds(frame.id), weights, 3, 0);
            const auto fractions = volume_fractions(frame, chosen, weights.size());
            const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
            for (size_t k = 0; k < weights.size(); ++k) EXPECT_NEAR(fractions[k], weights[k] / sum, 0.002) << count;
        }
    }
    // Why the scheme is needed: independent draws miss by far more.
    const ParticleFrame frame = test::random_spheres(million, 100, 1.0);
    double worst = 0;
    for (uint64_t seed = 0; seed < 5; ++seed) {
        const RandomMixture drawn = random_mixture({0.5, 0.5}, seed);
        worst = std::max(worst, std::abs(volume_fractions(frame, test::types_of(drawn, frame), 2)[0] - 0.5));
    }
    EXPECT_GT(worst, 0.004);
}

TEST(RandomByVolume, EverySizeClassIsMixedByTheWeights)
{
    const ParticleFrame frame = test::random_spheres(million, 100, 0.5);
    const std::vector<double> weights{0.3, 0.7};
    const auto chosen = choose_by_volume(frame.radius, SphereIds(frame.id), weights, 1, 0);
    for (const auto& [lo, hi] : {std::pair{0.0f, 0.5f}, {0.5f, 1.0f}, {1.0f, 2.0f}, {2.0f, 100.0f}}) {
        double first = 0, all = 0;
        for (size_t i = 0; i < frame.size(); ++i) {
            if (frame.radius[i] < lo || frame.radius[i] >= hi) continue;
            all += 1;
            first += chosen[i] == 0;
        }
        EXPECT_NEAR(first / all, 0.3, 4 * std::sqrt(0.21 / all) + 1e-3) << lo << ".." << hi;
    }
}

TEST(RandomByVolume, NeighboursInSpaceAreIndependentAndSeedsDiffer)
{
    ParticleFrame frame = test::random_spheres(million, 100, 0); // equal spheres: ranked by their hash alone
    const std::vector<double> weights{1, 1, 1};
    const auto first = choose_by_volume(frame.radius, SphereIds(frame.id), weights, 1, 0);
    const auto second = choose_by_volume(frame.radius, SphereIds(frame.id), weights, 2, 0);
    std::vector<double> next(9, 0), other(9, 0);
    for (size_t i = 0; i + 1 < first.size(); ++i) {
        next[3 * first[i] + first[i + 1]] += 1;
        other[3 * first[i] + second[i]] += 1;
    }
    const std::vector<double> expected(9, double(million - 1) / 9);
    EXPECT_GT(chi_square(next, expected).p_value, 1e-4) << chi_square(next, expected).text;
    EXPECT_GT(chi_square(other, expected).p_value, 1e-4) << chi_square(other, expected).text;
}

TEST(RandomByVolume, OddSets)
{
    EXPECT_TRUE(choose_by_volume({}, SphereIds(), std::vector<double>{1, 1}, 0, 0).empty());
    const std::vector<float> points(10, 0.0f), tiny(1000, 1e-30f);
    EXPECT_EQ(choose_by_volume(points, SphereIds(), std::vector<double>{1, 1}, 0, 0).size(), 10u);
    double first = 0;
    for (const uint32_t k : choose_by_volume(tiny, SphereIds(), std::vector<double>{1, 3}, 0, 0)) first += k == 0;
    EXPECT_NEAR(first, 250, 1);
    EXPECT_THROW(choose_by_volume(tiny, SphereIds(), std::vector<double>(1025, 1), 0, 0), std::invalid_argument);
}

} // namespace
} // namespace scree
