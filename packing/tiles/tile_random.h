#pragma once

#include "base/hash.h"

#include <Imath/ImathVec.h>

#include <cstdint>

namespace scree {

/// A stream of random numbers: SplitMix64 (see base/hash.h), the same on every machine.
class TileRandom {
public:
    /// stream: distinguishes the independent uses of one seed.
    TileRandom(uint64_t seed, uint64_t stream) : state_(hash_key(seed, stream)) {}

    uint64_t next() { return mix64(state_ += 0x9e3779b97f4a7c15ull); }
    /// In [0, 1).
    double uniform() { return unit_double(next()); }
    /// Uniform in 0 .. count - 1 (to 2^-32 of it).
    uint64_t below(uint64_t count) { return static_cast<uint64_t>(uniform() * static_cast<double>(count)); }
    /// Uniform in the unit cube.
    Imath::V3d cube()
    {
        const double x = uniform(), y = uniform(), z = uniform();
        return {x, y, z};
    }

private:
    uint64_t state_;
};

} // namespace scree
