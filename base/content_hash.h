#pragma once

#include "base/hash.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace scree {

/// Hash of bytes, eight at a time.
inline uint64_t hash_bytes(const void* data, size_t bytes, uint64_t seed)
{
    const auto* p = static_cast<const unsigned char*>(data);
    uint64_t hash = mix64(seed + bytes);
    for (size_t i = 0; i < bytes; i += 8) {
        uint64_t word = 0;
        std::memcpy(&word, p + i, std::min<size_t>(8, bytes - i));
        hash = mix64(hash ^ word) + 0x9e3779b97f4a7c15ull;
    }
    return hash;
}

template <class T>
uint64_t hash_vector(const std::vector<T>& v, uint64_t seed)
{
    return hash_bytes(v.data(), v.size() * sizeof(T), seed);
}

/// Hash of a file's bytes; the seed itself when the file cannot be read.
inline uint64_t hash_file(const std::filesystem::path& file, uint64_t seed)
{
    std::ifstream in(file, std::ios::binary);
    std::vector<char> block(1 << 20);
    while (in) {
        in.read(block.data(), static_cast<std::streamsize>(block.size()));
        seed = hash_bytes(block.data(), static_cast<size_t>(in.gcount()), seed);
    }
    return seed;
}

} // namespace scree
