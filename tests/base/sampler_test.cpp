#include "base/sampler.h"

#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

// Known answers published with Random123 (Salmon et al. 2011), kat_vectors, philox4x32 10 rounds.
TEST(Sampler, PhiloxGivesThePublishedNumbers)
{
    using Four = std::array<uint32_t, 4>;
    EXPECT_EQ(Sampler::philox({0, 0, 0, 0}, {0, 0}), (Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(Sampler::philox({~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}),
              (Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(Sampler::philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Sampler, IsAFunctionOfItsArguments)
{
    Sampler a(9, 1, 2, 3), b(9, 1, 2, 3), c(9, 2, 1, 3);
    bool differs = false;
    for (int i = 0; i < 100; ++i) {
        const double x = a.next();
        EXPECT_EQ(x, b.next());
        EXPECT_GT(x, 0);
        EXPECT_LT(x, 1);
        differs |= x != c.next();
    }
    EXPECT_TRUE(differs);
}

// Neighbouring pixels, samples and dimensions are uncorrelated: 30,000 pairs each, 4 standard errors.
TEST(Sampler, NeighboursAreUncorrelated)
{
    Estimate pixel, sample, dimension;
    for (uint32_t i = 0; i < 30000; ++i) {
        Sampler a(1, i, 0, 0), b(1, i + 1, 0, 0), c(1, i, 0, 1);
        const double x = a.next() - 0.5;
        pixel.add(x * (b.next() - 0.5));
        sample.add(x * (c.next() - 0.5));
        dimension.add(x * (a.next() - 0.5));
    }
    EXPECT_LT(std::abs(pixel.z(0)), 4);
    EXPECT_LT(std::abs(sample.z(0)), 4);
    EXPECT_LT(std::abs(dimension.z(0)), 4);
}

} // namespace
} // namespace scree
