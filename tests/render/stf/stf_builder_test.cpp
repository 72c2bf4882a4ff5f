// How shell transport functions are made, also from few walks, and how they are kept.

#include "base/error.h"
#include "render/stf/stf_cache.h"
#include "tests/builders/test_files.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cstring>
#include <fstream>
#include <numeric>

namespace scree {
namespace {

using namespace test;

TEST(StfBuilder, WeightsSumToOneHoweverFewTheRecords)
{
    // At this g a walk rarely turns by a large angle. Where only few records have such a turn, the tilt that would make
    // both means exact gives other records a negative weight.
    uint64_t cut = 0;
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        StfOptions options;
        options.walks = 1 << 10;
        options.records = 1 << 6;
        options.seed = seed;
        Stf stf(0.999);
        extend_stf(stf, 4, options, Progress());
        for (const StfShell& shell : stf.shells) {
            double sum = 0;
            for (const float weight : shell.exit_weights) {
                EXPECT_TRUE(weight >= 0 && std::isfinite(weight)) << weight;
                sum += weight;
                cut += weight == 0;
            }
            EXPECT_NEAR(sum, 1, 1e-6) << "seed " << seed << ", R " << shell.radius;
        }
    }
    EXPECT_GT(cut, 5u);
    for (const double g : {-0.999999, 0.999999, 1 - 1e-12}) { // almost all records are equal
        StfOptions options;
        options.walks = 1 << 10;
        options.records = 1 << 6;
        Stf stf(g);
        extend_stf(stf, 2, options, Progress());
        for (const StfShell& shell : stf.shells)
            EXPECT_NEAR(std::accumulate(shell.exit_weights.begin(), shell.exit_weights.end(), 0.0), 1, 1e-6) << g;
    }
}

TEST(StfBuilder, TheSameWhateverTheThreadsAndWhenItWasMade)
{
    StfOptions options;
    options.walks = 1 << 12;
    options.records = 1 << 9;
    const auto equal = [](const Stf& a, const Stf& b) {
        ASSERT_EQ(a.shells.size(), b.shells.size());
        for (size_t i = 0; i < a.shells.size(); ++i) {
            EXPECT_EQ(std::memcmp(a.shells[i].exits.data(), b.shells[i].exits.data(),
                                  a.shells[i].exits.size() * sizeof(ShellExit)),
                      0)
                << i;
            EXPECT_EQ(std::memcmp(a.shells[i].events.data(), b.shells[i].events.data(),
                                  a.shells[i].events.size() * sizeof(ShellEvent)),
                      0)
                << i;
            EXPECT_EQ(a.shells[i].exit_weights, b.shells[i].exit_weights);
            EXPECT_EQ(a.shells[i].event_sum, b.shells[i].event_sum);
        }
    };
    Stf all(0.5), later(0.5), alone(0.5);
    extend_stf(all, 6, options, Progress());
    extend_stf(later, 2, options, Progress());
    extend_stf(later, 6, options, Progress());
    equal(all, later);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    extend_stf(alone, 6, options, Progress());
    equal(all, alone);
}

TEST(StfCache, IsKeptOnDiskAndMadeAgainWhenDamaged)
{
    const TemporaryFolder folder;
    StfOptions options;
    options.walks = 1 << 10;
    options.records = 1 << 7;
    const auto find = [&](size_t shells) {
        return StfCache(folder.path(""), options).find(0.3, nullptr, shells, Progress());
    };
    const auto first = find(3);
    EXPECT_EQ(first.computed, 3u);
    EXPECT_EQ(find(3).computed, 0u);
    EXPECT_EQ(find(2).stf->shells.size(), 3u);
    EXPECT_EQ(find(5).computed, 2u);
    EXPECT_EQ(find(5).computed, 0u);

    std::filesystem::path file;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path(""))) file = entry.path();
    std::ifstream in(file, std::ios::binary);
    const std::string good{std::istreambuf_iterator<char>(in), {}};
    int damages = 0;
    for (const size_t at : {size_t{0}, size_t{9}, size_t{13}, size_t{20}, size_t{30}, size_t{40}, size_t{60},
                            good.size() / 2, good.size() - 1}) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ 0x40);
        std::ofstream(file, std::ios::binary) << bad;
        const auto found = find(5);
        EXPECT_EQ(found.computed, 5u) << at;
        EXPECT_NE(found.remark, "") << at;
        ++damages;
    }
    for (const size_t length : {size_t{0}, size_t{7}, size_t{50}, good.size() - 4}) {
        std::ofstream(file, std::ios::binary) << good.substr(0, length);
        EXPECT_EQ(find(5).computed, 5u) << length;
    }
    EXPECT_EQ(damages, 9);
    EXPECT_EQ(find(5).computed, 0u); // mended
}

TEST(StfBuilder, RefusesWhatCannotBe)
{
    Stf stf(0.0);
    StfOptions few;
    few.walks = 10;
    EXPECT_THROW(extend_stf(stf, 1, few, Progress()), InputError);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(extend_stf(stf, 1, {}, progress), Cancelled);
    EXPECT_TRUE(stf.shells.empty());
    EXPECT_EQ(Stf::largest(0.99, 5), -1);
    EXPECT_EQ(Stf::largest(1, 5), 0);
    EXPECT_EQ(Stf::largest(1e30, 5), 4);
    EXPECT_EQ(Stf::largest(NAN, 5), -1);
    EXPECT_EQ(Stf::largest(2, 0), -1);
    for (size_t k = 0; k < 40; ++k) {
        EXPECT_EQ(Stf::largest(Stf::radius(k), 99), static_cast<int>(k));
        EXPECT_EQ(Stf::largest(std::nextafter(Stf::radius(k), 0.0), 99), static_cast<int>(k) - 1);
    }
}

} // namespace
} // namespace scree
