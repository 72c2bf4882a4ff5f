// The stress test of `scree bench --stress`: its cases pass, and its comparisons find the deviations they should find.

#include "base/sampler.h"
#include "render/stress/stress.h"
#include "render/stress/stress_comparison.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace scree {
namespace {

TEST(StressQuick, EveryCasePasses)
{
    const StressReport report = run_stress({.quick = true, .only = ""}, {});
    EXPECT_TRUE(report.passed()) << stress_text(report);
    size_t cases = 0;
    for (const StressFamily& family : report.families) {
        cases += family.cases.size();
        for (const StressCase& c : family.cases) EXPECT_EQ(c.finding.non_finite, 0u) << c.name;
    }
    EXPECT_GT(cases, 25u);
    EXPECT_EQ(stress_json(report).at("passed").get<bool>(), report.passed());
}

/// Noise with mean 1 whose right half is brighter by the part `brighter`.
Film noise(uint64_t seed, double brighter)
{
    Film film(24, 18, 0, 0, 24, 18);
    for (int y = 0; y < 18; ++y) {
        for (int x = 0; x < 24; ++x) {
            for (uint32_t s = 0; s < 64; ++s) {
                Sampler sampler(seed, static_cast<uint32_t>(x), static_cast<uint32_t>(y), s);
                const auto value = static_cast<float>((x < 12 ? 1 : 1 + brighter) * 2 * sampler.next());
                film.at(x, y).add(Color(value), {});
            }
        }
    }
    return film;
}

TEST(StressComparison, FailsRarelyAndSeesWhatItSays)
{
    int failed = 0;
    for (uint64_t seed = 0; seed < 200; ++seed) {
        const StressFinding none = compare_means(noise(2 * seed, 0), noise(2 * seed + 1, 0), 6);
        failed += none.deviation > none.allowed;
    }
    EXPECT_LE(failed, 1);
    const StressFinding all = compare_means(noise(1, 0), noise(2, 0), 6);
    int seen = 0;
    for (uint64_t seed = 0; seed < 100; ++seed) {
        Film brighter = noise(2 * seed + 1, 0);
        for (Pixel& pixel : brighter.pixels()) {
            pixel.sum *= 1 + all.sees;
            pixel.sum_of_squares *= (1 + all.sees) * (1 + all.sees);
        }
        const StressFinding found = compare_means(noise(2 * seed, 0), brighter, 6);
        seen += found.deviation > found.allowed;
    }
    EXPECT_GT(seen, 80); // nine in ten of 100: standard deviation 3
    const StressFinding half = compare_means(noise(1, 0), noise(2, 0.1), 6);
    EXPECT_GT(half.deviation, half.allowed);
    EXPECT_LE(compare_means(noise(1, 0), noise(2, 0.01), 6, 0.05).deviation, half.allowed);
}

TEST(StressComparison, LossIsSeenNearOne)
{
    Film film(8, 8, 0, 0, 8, 8);
    for (Pixel& pixel : film.pixels()) {
        for (int s = 0; s < 1000; ++s) pixel.add(Color(s % 500 == 0 ? 0.f : 1.f), {});
    }
    const StressFinding right = compare_loss(film, 0.002), none = compare_loss(film, 0.003);
    EXPECT_LE(right.deviation, right.allowed);
    EXPECT_GT(none.deviation, none.allowed);
    Film whole(8, 8, 0, 0, 8, 8);
    for (Pixel& pixel : whole.pixels()) {
        for (int s = 0; s < 1000; ++s) pixel.add(Color(1), {});
    }
    const StressFinding dropped = compare_loss(whole, 0.002, 0.03);
    EXPECT_GT(dropped.deviation, dropped.allowed) << "nothing absorbed where 0.2 % should be";
}

TEST(StressComparison, LevelIsSharedByTheTests)
{
    EXPECT_NEAR(critical_z(0.05, 1), 1.95996, 1e-4);
    EXPECT_NEAR(critical_z(1e-4, 39), 4.70, 0.01);
    EXPECT_NEAR(std::pow(1 - std::erfc(critical_z(0.01, 7) * std::sqrt(0.5)), 7), 0.99, 1e-9);
}

TEST(StressComparison, NonFiniteAndUnfinishedFail)
{
    StressCase c;
    c.finding.allowed = 1;
    EXPECT_TRUE(c.passed());
    c.finding.non_finite = 1;
    EXPECT_FALSE(c.passed());
    c.finding.non_finite = 0;
    c.finding.stopped = 1;
    EXPECT_FALSE(c.passed());
    c.finding.stopped = 0;
    c.finding.leaks = 1;
    EXPECT_FALSE(c.passed()) << "a lost ray";
    c.finding.leaks = 0;
    c.finding.sees = 0.04;
    EXPECT_FALSE(c.passed()) << "too noisy to see 3 %";
    c.finding.must_see = 0.05;
    EXPECT_TRUE(c.passed());
    c.finding.paths = 4;
    c.finding.segments = 40;
    c.finding.least_length = 11;
    EXPECT_FALSE(c.passed()) << "not a long path";
    c.finding.least_length = 10;
    EXPECT_TRUE(c.passed());
    c.finding.deviation = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(c.passed());
}

} // namespace
} // namespace scree
