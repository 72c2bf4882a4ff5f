#pragma once

#include "base/hash.h"
#include "base/math.h"

namespace scree {

/// A stream of random numbers for making shapes: SplitMix64 (see base/hash.h), the same on every machine.
class ShapeRandom {
public:
    /// stream: selects one of the several independent streams of a seed.
    ShapeRandom(uint64_t seed, uint64_t stream) : state_(hash_key(seed, stream)) {}

    uint64_t next() { return mix64(state_ += 0x9e3779b97f4a7c15ull); }
    /// In [0, 1).
    double uniform() { return unit_double(next()); }
    double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
    /// Uniform in the unit ball, by rejection: without trigonometric functions, whose last bits differ between
    /// machines.
    V3d in_ball()
    {
        while (true) {
            const double x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
            const V3d p(x, y, z);
            if (p.length2() <= 1 && p.length2() > 0x1p-20) return p;
        }
    }
    /// Uniform over the unit sphere.
    V3d direction() { return in_ball().normalized(); }

private:
    uint64_t state_;
};

} // namespace scree
