#pragma once

#include <cstdint>

namespace scree {

/// A stable 64-bit mix: the finaliser of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014; constants by Stafford, variant
/// 13).
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

/// The part of `hash_index` that does not depend on the index, for loops over many indices.
constexpr uint64_t hash_key(uint64_t seed, uint64_t stream = 0)
{
    return mix64(seed * 0x9e3779b97f4a7c15ull + stream + 1);
}

/// hash_index(index, seed, stream) for key = hash_key(seed, stream).
constexpr uint64_t hash_with_key(uint64_t index, uint64_t key)
{
    return mix64(mix64(index + 0x9e3779b97f4a7c15ull) ^ key);
}

/// Hash of an index with a seed and a stream; the stream selects one of several random quantities of a grain.
///
/// mix64(mix64(index + G) ^ mix64(seed G + stream + 1)), G = 0x9e3779b97f4a7c15 (2^64 over the golden ratio), modulo
/// 2^64.
constexpr uint64_t hash_index(uint64_t index, uint64_t seed, uint64_t stream = 0)
{
    return hash_with_key(index, hash_key(seed, stream));
}

/// The upper 53 bits of a hash as a number in [0, 1).
constexpr double unit_double(uint64_t hash) { return static_cast<double>(hash >> 11) * 0x1p-53; }

} // namespace scree
