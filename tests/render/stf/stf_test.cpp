// Shell transport functions against walks that simulate every scattering, against quadrature, and for consistency.

#include "base/error.h"
#include "render/stf/shell_walk.h"
#include "render/stf/stf_cache.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

namespace scree {
namespace {

/// Shells that are made once for all tests of a program.
std::shared_ptr<const Stf> shells_of(double g, size_t count)
{
    static StfCache cache{{}};
    return cache.find(g, nullptr, count, Progress()).stf;
}

std::vector<ShellWalk> simulate(const PhaseFunction& phase, double radius, size_t count, uint64_t seed)
{
    std::vector<ShellWalk> walks(count);
    tbb::parallel_for(size_t{0}, count, [&](size_t i) {
        Sampler sampler(seed, static_cast<uint32_t>(i), 0, 0);
        do walks[i] = walk_in_shell(phase, radius, {}, sampler);
        while (walks[i].exit.events == 0);
    });
    return walks;
}

struct Case {
    double g;
    size_t shell;
};
const std::vector<Case> cases{{0, 0}, {0, 3}, {0, 6}, {0, 10}, {0.8, 2}, {0.8, 8}, {-0.5, 6}, {0.95, 9}};

/// Share of the light that scatters once: int_0^R exp(-t) int p(mu) exp(-d(t, mu)) dmu dt by midpoints, where d is the
/// distance from the scattering to the shell.
double single_part(double g, double radius)
{
    constexpr int n = 1500;
    double single = 0;
    for (int i = 0; i < n; ++i) {
        const double t = radius * (i + 0.5) / n;
        for (int j = 0; j < n; ++j) {
            const double mu = sample_henyey_greenstein(g, (j + 0.5) / n);
            single += std::exp(-t - (std::sqrt(radius * radius - t * t * (1 - mu * mu)) - t * mu)) * radius / n / n;
        }
    }
    return single;
}

TEST(Stf, ScattersNeverOnceAndMoreOftenAsQuadratureHasIt)
{
    for (const double g : {0.0, 0.8}) {
        const auto stf = shells_of(g, 5);
        for (const size_t k : {0u, 2u, 4u}) {
            const double radius = Stf::radius(k), single = single_part(g, radius);
            Estimate none, once, more;
            for (uint32_t i = 0; i < 200'000; ++i) {
                Sampler sampler(3, i, 1, 2);
                const uint32_t events = walk_in_shell(PhaseFunction(g), radius, {}, sampler).exit.events;
                none.add(events == 0);
                once.add(events == 1);
                more.add(events > 1);
            }
            EXPECT_LT(std::abs(none.z(std::exp(-radius))), 4) << radius;
            EXPECT_LT(std::abs(once.z(single)), 4)
                << g << ", " << radius << ": " << once.mean() << " against " << single;

            // The shares that a path uses; their weights alone make them sum to 1.
            const StfShell& shell = stf->shells[k];
            const double scattered = 1 - std::exp(-radius);
            double recorded = 0, multiple = 0;
            for (size_t i = 0; i < shell.exits.size(); ++i)
                (shell.exits[i].events == 1 ? recorded : multiple) += shell.exit_weights[i] * scattered;
            const double part = single / scattered,
                         error = scattered * std::sqrt(part * (1 - part) / static_cast<double>(StfOptions().walks));
            EXPECT_LT(std::abs(recorded - single), 4 * error) << g << ", " << radius;
            EXPECT_LT(std::abs(multiple - (1 - std::exp(-radius) - single)), 4 * error) << g << ", " << radius;
            EXPECT_LT(std::abs(multiple - more.mean()), 4 * std::hypot(error, more.standard_error()))
                << g << ", " << radius;
        }
    }
}

/// Cells of place, direction and number of scatterings; 8 x 3 x 2 x 4 of them.
struct Cells {
    uint32_t quartiles[3];

    explicit Cells(const std::vector<ShellWalk>& walks)
    {
        std::vector<uint32_t> events;
        for (const ShellWalk& walk : walks) events.push_back(walk.exit.events);
        std::ranges::sort(events);
        for (size_t q = 0; q < 3; ++q) quartiles[q] = events[(q + 1) * events.size() / 4];
    }
    static constexpr size_t count = 8 * 3 * 2 * 4;
    size_t of(const ShellExit& exit) const
    {
        const auto place = static_cast<size_t>(std::clamp((exit.cos_t + 1) * 4.0, 0.0, 7.0));
        const double out2 = 1 - double{exit.away} * exit.away -
                            double{exit.across} * exit.across; // uniform, were the direction cosine distributed
        const auto out = static_cast<size_t>(std::clamp(out2 * 3, 0.0, 2.0));
        const size_t side = exit.away > 0;
        const size_t events = static_cast<size_t>(std::upper_bound(quartiles, quartiles + 3, exit.events) - quartiles);
        return ((place * 3 + out) * 2 + side) * 4 + events;
    }
};

TEST(Stf, RecordsAreAsWalksAreInPlaceDirectionAndEvents)
{
    // Power: a shell's records have the noise of their own walks and of the smaller shells that these walks used. The
    // latter is taken as half of the former's variance for each smaller shell: a bound that is not measured. So an
    // error of 20 % in an average cell of the 192 shows at 2.9 standard errors in the smallest shell, 1.9 in the tenth,
    // and 1.4 in the eleventh, which has a quarter of the walks. An error in many cells shows far earlier in the sum.
    constexpr size_t n = 60'000;
    const double level = sidak(1e-4, static_cast<int>(cases.size()));
    for (const Case& c : cases) {
        const auto stf = shells_of(c.g, c.shell + 1);
        const std::vector<ShellWalk> walks = simulate(stf->phase, Stf::radius(c.shell), c.shell >= 10 ? n / 4 : n, 11);
        const Cells cells(walks);
        std::vector<double> direct(Cells::count, 0.0), mass(Cells::count, 0.0), variance(Cells::count, 0.0);
        for (const ShellWalk& walk : walks) direct[cells.of(walk.exit)] += 1;
        const StfShell& shell = stf->shells[c.shell];
        for (size_t i = 0; i < shell.exits.size(); ++i) mass[cells.of(shell.exits[i])] += shell.exit_weights[i];
        // As sums over as many walks as were simulated; the variance grows by the share of the smaller shells.
        const double walked = static_cast<double>(walks.size()), chained = 1 + 0.5 * static_cast<double>(c.shell);
        for (size_t i = 0; i < mass.size(); ++i) {
            mass[i] *= walked;
            variance[i] = mass[i] * walked / static_cast<double>(StfOptions().walks) * chained;
        }
        const ChiSquare test = chi_square_two(direct, mass, variance);
        EXPECT_GT(test.p_value, level) << "g " << c.g << ", R " << Stf::radius(c.shell) << ": " << test.text;
        EXPECT_GT(test.degrees, 20) << "g " << c.g << ", R " << Stf::radius(c.shell);
    }
}

TEST(Stf, WhatIsLeftAtAnAlbedoIsAsWalksHaveIt)
{
    for (const Case& c : cases) {
        const auto stf = shells_of(c.g, c.shell + 1);
        const double radius = Stf::radius(c.shell);
        const std::vector<ShellWalk> walks = simulate(stf->phase, radius, c.shell >= 10 ? 20'000 : 80'000, 12);
        for (const double albedo : {1.0, 0.999, 0.97, 0.8}) {
            const ShellSampler sampler(stf->shells[c.shell], albedo);
            if (sampler.survival() < 1e-5) continue; // only a few walks would count
            // The same sums over walks and over draws: survival, forward part, outward part; and two sums over
            // scatterings near the shell.
            Estimate left, forward, outward, near, depth;
            for (const ShellWalk& walk : walks) {
                const double weight = std::pow(albedo, walk.exit.events);
                left.add(weight);
                forward.add(weight * walk.exit.cos_t);
                outward.add(weight * place_of(walk.exit).direction.dot(place_of(walk.exit).place));
                const double event = walk.event_sum * std::pow(albedo, walk.event.events);
                near.add(event);
                depth.add(event * walk.event.direction.z);
            }
            Estimate drawn_forward, drawn_outward, drawn_depth;
            for (uint32_t i = 0; i < 100'000; ++i) {
                Sampler random(5, i, 0, 0);
                const ShellExit& exit = sampler.exit(random.next());
                drawn_forward.add(sampler.survival() * exit.cos_t);
                drawn_outward.add(sampler.survival() * place_of(exit).direction.dot(place_of(exit).place));
                drawn_depth.add(sampler.event_weight() * sampler.event(random.next()).direction.z);
            }
            // The records have the noise of about 2^17 walks of their own, and of the walks in smaller shells.
            const double chained = 1 + 0.5 * static_cast<double>(c.shell);
            const auto own = [&](const Estimate& e) {
                return e.standard_error() *
                       std::sqrt(static_cast<double>(e.count()) / static_cast<double>(StfOptions().walks) * chained);
            };
            const auto expect = [&](const Estimate& walked, double drawn, double error, const char* what) {
                const double sigma =
                    std::sqrt(std::pow(walked.standard_error(), 2) + std::pow(own(walked), 2) + error * error);
                EXPECT_LT(std::abs(walked.mean() - drawn), 4.5 * sigma + 1e-9)
                    << what << ", g " << c.g << ", R " << radius << ", albedo " << albedo << ": " << walked.mean()
                    << " +- " << sigma << " against " << drawn;
            };
            expect(left, sampler.survival(), 0, "left");
            expect(forward, drawn_forward.mean(), drawn_forward.standard_error(), "forward");
            expect(outward, drawn_outward.mean(), drawn_outward.standard_error(), "outward");
            expect(near, sampler.event_weight(), 0, "near the shell");
            expect(depth, drawn_depth.mean(), drawn_depth.standard_error(), "direction near the shell");
        }
    }
}

TEST(Stf, KeepsWhatEveryWalkKeepsInTheMean)
{
    // The two identities of calibrate() in stf_builder.cpp: here for simulated walks, and for records up to rounding.
    for (const double g : {0.0, 0.8, -0.5}) {
        const auto stf = shells_of(g, 9);
        for (const size_t k : {0u, 4u, 8u}) {
            const double radius = Stf::radius(k);
            Estimate drift, growth;
            for (uint32_t i = 0; i < 40'000; ++i) {
                Sampler sampler(21, i, static_cast<uint32_t>(k), 0);
                const ShellExit exit = walk_in_shell(stf->phase, radius, {}, sampler).exit;
                const ShellPlace there = place_of(exit);
                drift.add((1 - g) * radius * exit.cos_t + there.direction.z);
                growth.add(exit.events - radius * there.place.dot(there.direction));
            }
            EXPECT_LT(std::abs(drift.z(1)), 4) << g << ", " << radius;
            EXPECT_LT(std::abs(growth.z(0.5 * (1 - g) * radius * radius)), 4) << g << ", " << radius;
        }
        for (const StfShell& shell : stf->shells) {
            const double straight = std::exp(-shell.radius);
            double drift = straight * ((1 - g) * shell.radius + 1), growth = -straight * shell.radius;
            for (size_t i = 0; i < shell.exits.size(); ++i) {
                const ShellPlace there = place_of(shell.exits[i]);
                const double w = (1 - straight) * shell.exit_weights[i];
                drift += w * ((1 - g) * shell.radius * shell.exits[i].cos_t + there.direction.z);
                growth += w * (shell.exits[i].events - shell.radius * there.place.dot(there.direction));
            }
            EXPECT_NEAR(drift, 1, 1e-4) << g << ", " << shell.radius;
            EXPECT_NEAR(growth / (0.5 * (1 - g) * shell.radius * shell.radius), 1, 1e-4) << g << ", " << shell.radius;
        }
    }
}

TEST(Stf, LargeShellsAreAsDiffusionHasThem)
{
    // Isotropic scattering, an extrapolated boundary 0.7104 beyond the shell (Milne's problem): the mean number of
    // scatterings of light from a ball's centre is (R + 0.7104)^2 / (2 D) with D = 1 a scattering, up to a term of the
    // order of 1; and it leaves with a mean cosine of 0.7104, up to one of 1 / R.
    const auto stf = shells_of(0, 15);
    for (const size_t k : {12u, 14u}) {
        const StfShell& shell = stf->shells[k];
        double events = 0, out = 0;
        for (size_t i = 0; i < shell.exits.size(); ++i) {
            events += double{shell.exit_weights[i]} * shell.exits[i].events;
            out += shell.exit_weights[i] * place_of(shell.exits[i]).direction.dot(place_of(shell.exits[i]).place);
        }
        const double reach = shell.radius + 0.7104;
        EXPECT_NEAR(events / (0.5 * reach * reach), 1, 0.015)
            << shell.radius; // standard error 0.8 / sqrt(2^17) per shell, summed over the ten or so shells used
        EXPECT_NEAR(out, 0.7104, 0.005) << shell.radius;
    }
}

TEST(Stf, PlacesAndDirectionsComeBackFromTheirRecords)
{
    Sampler sampler(1, 2, 3, 4);
    for (int i = 0; i < 1000; ++i) {
        const double phi = 2 * pi * sampler.next(), c = 2 * sampler.next() - 1, s = safe_sqrt(1 - c * c);
        const V3d place(s * std::cos(phi), s * std::sin(phi), c);
        V3d direction(sampler.next() - 0.5, sampler.next() - 0.5, sampler.next() - 0.5);
        direction = direction.normalized();
        if (direction.dot(place) < 0.01) continue;
        const ShellPlace back = place_of(exit_at(place, direction)); // turned about z so that it lies over x
        EXPECT_NEAR(back.place.z, place.z, 1e-6);
        EXPECT_NEAR(back.place.y, 0, 1e-6);
        EXPECT_NEAR(back.direction.z, direction.z, 1e-5);
        EXPECT_NEAR(back.direction.dot(back.place), direction.dot(place), 1e-5);
        EXPECT_NEAR(back.direction.length(), 1, 1e-6);
    }
}

TEST(PhaseTable, SamplesAsItsDensity)
{
    CosineTable table;
    for (uint32_t i = 0; i < CosineTable::bins; ++i) table.density[i] = i % 7 == 0 ? 0 : std::exp(0.05 * i);
    double sum = 0;
    for (const double d : table.density) sum += d * CosineTable::width();
    for (double& d : table.density) d /= sum;
    const PhaseTable phase(table);
    std::vector<double> observed(CosineTable::bins, 0.0), expected(CosineTable::bins, 0.0);
    constexpr int n = 200'000;
    Estimate cosine;
    for (int i = 0; i < n; ++i) {
        Sampler sampler(1, static_cast<uint32_t>(i), 0, 0);
        const double c = phase.sample(sampler.next());
        observed[CosineTable::bin(c)] += 1;
        cosine.add(c);
    }
    for (uint32_t i = 0; i < CosineTable::bins; ++i)
        expected[i] = n * 2 * pi * phase.pdf((i + 0.5) * CosineTable::width() - 1) * CosineTable::width();
    const ChiSquare test = chi_square(observed, expected);
    EXPECT_GT(test.p_value, 1e-4) << test.text;
    EXPECT_LT(std::abs(cosine.z(phase.mean_cosine())), 4);
    table.density[3] = -1;
    EXPECT_THROW(PhaseTable{table}, InputError);
    EXPECT_THROW(PhaseTable{CosineTable{}}, InputError);
}

TEST(AliasTable, DrawsByWeight)
{
    std::vector<double> weights{0, 1, 5, 0, 0.001, 3, 1e-9, 2};
    const AliasTable table(weights);
    std::vector<double> observed(weights.size(), 0.0), expected;
    constexpr int n = 400'000;
    for (int i = 0; i < n; ++i) {
        Sampler sampler(1, static_cast<uint32_t>(i), 0, 0);
        observed[table.sample(sampler.next())] += 1;
    }
    double sum = 0;
    for (const double w : weights) sum += w;
    for (const double w : weights) expected.push_back(n * w / sum);
    EXPECT_EQ(observed[0], 0);
    EXPECT_EQ(observed[3], 0);
    const ChiSquare test = chi_square(observed, expected);
    EXPECT_GT(test.p_value, 1e-4) << test.text;
    const AliasTable even(std::vector<double>(3, 0.0));
    EXPECT_EQ(even.sample(0.1), 0u);
    EXPECT_EQ(even.sample(0.9), 2u);
}

} // namespace
} // namespace scree
