#pragma once

#include <cstdint>

namespace scree {

/// A stable 64-bit mix: the finaliser of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014; constants by Stafford, variant 13).
///
/// This function is part of the file formats: types and rotations of grains follow from it, on every machine and in
/// every version. Pinned by tests.
constexpr uint64_t mix64(uint64_t x)
{
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ull;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebull;
    x ^= x >> 31;
    return x;
}

/// Hash of an index under a seed and a stream (which of the several random things of one grain is meant).
constexpr uint64_t hash_index(uint64_t index, uint64_t seed, uint64_t stream = 0)
{
    constexpr uint64_t golden = 0x9e3779b97f4a7c15ull;
    return mix64(mix64(index + golden) ^ mix64(seed * golden + stream + 1));
}

/// The upper 53 bits of a hash as a number in [0, 1).
constexpr double unit_double(uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1p-53; }

} // namespace scree
