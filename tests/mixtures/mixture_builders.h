#pragma once

#include "ingest/particles/particle_frame.h"
#include "mixtures/make_mixture.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace scree::test {

/// A sequence of random numbers for tests.
class Numbers {
public:
    explicit Numbers(uint64_t seed) : seed_(seed) {}
    uint64_t bits();
    double unit(); ///< [0, 1)
    uint64_t below(uint64_t n) { return bits() % n; }

private:
    uint64_t seed_, count_ = 0;
};

/// `count` spheres in a cube of edge `edge` around `center`: ids 1, 2, ...; types 1, 2, 3, 1, ...; radii log-normal
/// with median 1 and the given sigma.
ParticleFrame random_spheres(size_t count, double edge, double sigma = 0, Imath::V3d center = Imath::V3d(0),
                             uint64_t seed = 1);

/// The mixture of a JSON text for the frame, with grain types "a" to "d"; the dump's types 1, 2, 3 are a, b, c.
std::unique_ptr<Mixture> mixture_of(const std::string& json, const ParticleFrame* frame,
                                    const std::filesystem::path& folder = ".");

/// The type of every sphere.
std::vector<uint32_t> types_of(const Mixture& mixture, const ParticleFrame& frame);

/// Writes a float grid "c" of `edge`^3 voxels of width 1, whose centres are at 0..edge - 1; value = x / (edge - 1).
void write_ramp(const std::filesystem::path& path, int edge);

} // namespace scree::test
