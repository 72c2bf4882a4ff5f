// The hash is part of the file formats: these tests compare it with values computed outside of Scree from the formulas
// in hash.h.

#include "base/hash.h"
#include "tests/mixtures/mixture_builders.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr uint64_t all = ~uint64_t{0};

TEST(Hash, Mix64)
{
    EXPECT_EQ(mix64(0), 0u);
    EXPECT_EQ(mix64(1), 0x5692161d100b05e5u);
    EXPECT_EQ(mix64(2), 0xdbd238973a2b148au);
    EXPECT_EQ(mix64(0x123456789abcdef), 0xb2c058e4ebb5112cu);
    EXPECT_EQ(mix64(all), 0xb4d055fcf2cbbd7bu);
    EXPECT_EQ(mix64(0x9e3779b97f4a7c15), 0xe220a8397b1dcdafu); // SplitMix64's first number of seed 0, as published
}

TEST(Hash, HashIndex)
{
    EXPECT_EQ(hash_index(0, 0), 0x48294f70ccf5e4fcu);
    EXPECT_EQ(hash_index(1, 0), 0x39b4332fd4168839u);
    EXPECT_EQ(hash_index(0, 1), 0x8e58975f6d0dc556u);
    EXPECT_EQ(hash_index(0, 0, 1), 0x3675d34e97b17c7au);
    EXPECT_EQ(hash_index(123456789, 42, 7), 0x8ca7faffd023bdefu);
    EXPECT_EQ(hash_index(all, all, all), 0xa5be29db51cb82beu);
    EXPECT_EQ(hash_with_key(123456789, hash_key(42, 7)), hash_index(123456789, 42, 7));
}

TEST(Hash, UnitDouble)
{
    EXPECT_EQ(unit_double(0), 0);
    EXPECT_EQ(unit_double(all), 1 - 0x1p-53);
    EXPECT_EQ(unit_double(hash_index(5, 3)), 0.5453860011109374);
}

std::string types_as_text(const std::string& json)
{
    const auto mixture = test::mixture_of(json, nullptr);
    std::string text;
    for (uint64_t i = 0; i < 64; ++i) text += static_cast<char>('0' + mixture->type(i, {}));
    return text;
}

TEST(Hash, TypesOfARandomMixture)
{
    EXPECT_EQ(types_as_text(R"({"kind": "random", "types": ["a", "b"], "weights": [3, 7], "seed": 1})"),
              "1010010011100111111010110000111111011111101011010111001101101011");
}

TEST(Hash, StreamsInsideABlend)
{
    // Mixture 1 of the blend has stream mix64(2 G).
    EXPECT_EQ(types_as_text(R"({"kind": "blend", "by": "n", "mixtures": {"m": "c",
                               "n": {"kind": "random", "types": ["a", "b"], "seed": 1}}})"),
              "1010000001011000110111001000101101111110000110101000011101001010");
}

} // namespace
} // namespace scree
