#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace scree {

/// Random numbers of one light path, counter-based: number d of sample s of pixel (x, y) under a seed is a pure
/// function of (seed, x, y, s, d), so that no order of work, thread count or resumption changes a picture.
///
/// Philox4x32-10 (Salmon, Moraes, Dror, Shaw, SC 2011): dimensions are independent, however long the path.
class Sampler {
public:
    Sampler(uint64_t seed, uint32_t x, uint32_t y, uint32_t sample)
        : key_{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32)}, counter_{0, sample, x, y}
    {
    }

    /// Uniform in (0, 1), both ends excluded, in steps of 2^-32.
    double next()
    {
        if (used_ == 4) refill();
        return (static_cast<double>(block_[used_++]) + 0.5) * 0x1p-32;
    }

    /// How many blocks of four numbers were drawn; at most 2^32 are possible.
    uint32_t blocks() const { return counter_[0]; }

    /// The four numbers of one block, for tests against the published vectors.
    static std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key)
    {
        for (int round = 0; round < 10; ++round) {
            const uint64_t a = uint64_t{0xD2511F53u} * counter[0];
            const uint64_t b = uint64_t{0xCD9E8D57u} * counter[2];
            counter = {static_cast<uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<uint32_t>(b),
                       static_cast<uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<uint32_t>(a)};
            key[0] += 0x9E3779B9u;
            key[1] += 0xBB67AE85u;
        }
        return counter;
    }

private:
    void refill()
    {
        block_ = philox(counter_, key_);
        ++counter_[0];
        used_ = 0;
    }

    std::array<uint32_t, 2> key_;
    std::array<uint32_t, 4> counter_;
    std::array<uint32_t, 4> block_{};
    uint32_t used_ = 4;
};

/// Draws from the exponential distribution of mean 1, with the full resolution of doubles at both ends.
///
/// With the sampler's steps of 2^-32 alone, no path would scatter at optical depths below 1e-10, and none would pass
/// through an optical depth of 23.
inline double draw_optical_depth(Sampler& sampler)
{
    const double u = sampler.next();
    constexpr double end = 0x1p-16;
    if (u < end) return -std::log1p(-(u + (sampler.next() - 0.5) * 0x1p-32));
    const double v = 1 - u; // exact
    if (v < end) return -std::log(v + (sampler.next() - 0.5) * 0x1p-32);
    return -std::log(v);
}

} // namespace scree
