#pragma once

#include "packing/solids/domain.h"
#include "packing/solids/tetrahedra.h"

#include <memory>
#include <string>

namespace scree {

/// Volume of a domain and points uniform in it, from TetGen's tetrahedra.
///
/// TetGen runs in a process of its own with limits of time and memory, so that no input can take this program down.
/// Where it fails (or was not built in: SCREE_TETGEN=OFF) the volume is by the divergence theorem and points are found
/// by rejection.
class InteriorSampler {
public:
    /// The domain must outlive the sampler.
    explicit InteriorSampler(const Domain& domain, const TetgenOptions& options = {});
    ~InteriorSampler();

    /// Scene units cubed.
    double volume() const;
    /// Uniform in the domain; a function of (index, seed) alone. Any thread.
    Imath::V3d sample(uint64_t index, uint64_t seed) const;
    /// "TetGen, 12345 tetrahedra", or what was used instead and why.
    const std::string& method() const;
    bool by_tetgen() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
