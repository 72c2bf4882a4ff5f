#include "packing/tiles/tile_sizes.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace scree {
namespace {

using testing::HasSubstr;

TileSizes sizes(const std::vector<std::string>& words) { return parse_tile_sizes(words); }

/// Sorted radii drawn from the distribution.
std::vector<double> drawn(const TileSizes& kind, uint64_t count, uint64_t seed)
{
    std::vector<double> radii = draw_tile_radii(kind, count, seed);
    std::ranges::sort(radii);
    return radii;
}

/// Kolmogorov-Smirnov distance between sorted numbers and a distribution function.
template <class Cdf>
double distance(const std::vector<double>& sorted, const Cdf& cdf)
{
    double worst = 0;
    const auto n = static_cast<double>(sorted.size());
    for (size_t i = 0; i < sorted.size(); ++i) {
        const double p = cdf(sorted[i]);
        worst =
            std::max({worst, std::abs(p - static_cast<double>(i) / n), std::abs(p - static_cast<double>(i + 1) / n)});
    }
    return worst;
}

TEST(TileSizes, MeanIsOneAndOrderIsRandom)
{
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"mono"}, {"bidisperse"}, {"lognormal"}, {"power"}}) {
        const std::vector<double> radii = draw_tile_radii(sizes(words), 5000, 3);
        double mean = 0, product = 0, square = 0;
        for (const double r : radii) mean += r / 5000;
        EXPECT_NEAR(mean, 1, 1e-12);
        for (size_t i = 0; i + 1 < radii.size(); ++i) product += (radii[i] - 1) * (radii[i + 1] - 1);
        for (const double r : radii) square += (r - 1) * (r - 1);
        // Correlation of neighbours: 0 with standard error 1/sqrt(5000).
        if (square > 1e-9) {
            EXPECT_LT(std::abs(product / square), 4 / std::sqrt(5000.0)) << words[0];
        }
    }
}

// A stratified sample has one radius in each n-th part of the distribution, so its distance from the distribution is at
// most 1/n. Scaling the sample to mean 1 adds the error of the sample's mean, which stratification keeps far below
// 1/sqrt(n).
TEST(TileSizes, LognormalFollowsItsDistribution)
{
    const std::vector<double> radii = drawn(sizes({"lognormal", "sigma=0.3"}), 10000, 1);
    const double scale = std::exp(-0.3 * 0.3 / 2); // mean 1
    EXPECT_LT(
        distance(radii, [&](double r) { return std::erfc(-std::log(r / scale) / 0.3 / std::numbers::sqrt2) / 2; }),
        4e-4);
}

TEST(TileSizes, PowerLawFollowsItsDistribution)
{
    for (const double exponent : {3.0, 1.0, 0.0, 4.5}) {
        const std::vector<double> radii =
            drawn(sizes({"power", "exponent=" + std::to_string(exponent), "ratio=20"}), 10000, 1);
        const double k = 1 - exponent, most = std::pow(20.0, k);
        const auto moment = [&](double power) { // mean of r^power over 1..20
            const double e = power - exponent + 1;
            return std::abs(e) < 1e-9 ? std::log(20.0) : (std::pow(20.0, e) - 1) / e;
        };
        const double mean = moment(1) / moment(0);
        const auto cdf = [&](double r) {
            const double x = std::clamp(r * mean, 1.0, 20.0);
            return std::abs(k) < 1e-9 ? std::log(x) / std::log(20.0) : (std::pow(x, k) - 1) / (most - 1);
        };
        EXPECT_LT(distance(radii, cdf), 2e-3) << exponent;
        EXPECT_LT(radii.back() / radii.front(), 20.0001);
    }
}

TEST(TileSizes, MinAndMaxAreARatio) { EXPECT_DOUBLE_EQ(sizes({"power", "min=0.5", "max=2"}).ratio, 4); }

TEST(TileSizes, TwoSizesAreCounted)
{
    const std::vector<double> radii = drawn(sizes({"bidisperse", "ratio=1.4", "share=0.3"}), 1001, 9);
    EXPECT_EQ(std::ranges::count(radii, radii.front()), 1001 - 300);
    EXPECT_EQ(std::ranges::count(radii, radii.back()), 300);
    EXPECT_NEAR(radii.back() / radii.front(), 1.4, 1e-12);
}

TEST(TileSizes, SamplesHoldOnlyTheRadiiGivenInTheirProportions)
{
    TileSizes kind;
    kind.kind = TileSizes::Kind::sample;
    kind.radii = {3, 1, 2, 1};
    const std::vector<double> radii = drawn(kind, 4000, 2);
    const std::set<double> different(radii.begin(), radii.end());
    ASSERT_EQ(different.size(), 3u);
    EXPECT_NEAR(static_cast<double>(std::ranges::count(radii, *different.begin())), 2000, 2);
    EXPECT_NEAR(*different.rbegin() / *different.begin(), 3, 1e-12);
}

TEST(TileSizes, SeedsDecide)
{
    const TileSizes kind = sizes({"lognormal"});
    EXPECT_EQ(draw_tile_radii(kind, 100, 5), draw_tile_radii(kind, 100, 5));
    EXPECT_NE(draw_tile_radii(kind, 100, 5), draw_tile_radii(kind, 100, 6));
}

// Desmond and Weeks, with the lognormal's own polydispersity 0.3069 and skewness 0.9495.
TEST(TileSizes, RandomClosePackingOfTheLiterature)
{
    EXPECT_NEAR(random_close_packing(draw_tile_radii(sizes({"mono"}), 100, 1)), 0.634, 1e-12);
    EXPECT_NEAR(random_close_packing(draw_tile_radii(sizes({"lognormal"}), 100000, 1)),
                0.634 + 0.0658 * 0.30688 + 0.0857 * 0.94950 * 0.30688 * 0.30688, 2e-4);
}

TEST(TileSizes, BadWordsAreToldFromGoodOnes)
{
    const auto error = [](const std::vector<std::string>& words) {
        return std::string(test::input_error_of([&] { parse_tile_sizes(words); }).value().what());
    };
    EXPECT_THAT(error({"lognorml"}), HasSubstr("did you mean 'lognormal'"));
    EXPECT_THAT(error({}), HasSubstr("nothing"));
    EXPECT_THAT(error({"mono", "sigma=1"}), HasSubstr("mono alone"));
    EXPECT_THAT(error({"lognormal", "sigm=0.2"}), HasSubstr("did you mean 'sigma'"));
    EXPECT_THAT(error({"lognormal", "sigma"}), HasSubstr("sigma=NUMBER"));
    EXPECT_THAT(error({"lognormal", "sigma=x"}), HasSubstr("sigma=NUMBER"));
    EXPECT_THAT(error({"lognormal", "sigma=nan"}), HasSubstr("sigma=NUMBER"));
    EXPECT_THAT(error({"lognormal", "sigma=0.1", "sigma=0.2"}), HasSubstr("twice"));
    EXPECT_THAT(error({"lognormal", "sigma=5"}), HasSubstr("from 0 to 1"));
    EXPECT_THAT(error({"power", "ratio=1e9"}), HasSubstr("from 1 to 100"));
    EXPECT_THAT(error({"power", "min=1"}), HasSubstr("one of min and max"));
    EXPECT_THAT(error({"power", "min=2", "max=1"}), HasSubstr("max"));
    EXPECT_THAT(error({"power", "min=1", "max=2", "ratio=3"}), HasSubstr("ratio"));
    EXPECT_THAT(error({"bidisperse", "share=2"}), HasSubstr("from 0 to 1"));
}

} // namespace
} // namespace scree
