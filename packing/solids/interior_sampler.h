#pragma once

#include "packing/solids/domain.h"
#include "packing/solids/tetrahedra.h"

#include <memory>
#include <string>

namespace scree {

/// Volume of a domain, and points uniform in it, from TetGen's tetrahedra.
///
/// TetGen runs in a separate process with limits of time and memory, so that no input can crash this program. Where
/// TetGen fails (or was not built in: SCREE_TETGEN=OFF), the divergence theorem gives the volume, and rejection
/// sampling gives the points.
class InteriorSampler {
public:
    /// The domain must outlive the sampler.
    explicit InteriorSampler(const Domain& domain, const TetgenOptions& options = {});
    ~InteriorSampler();

    /// Scene units cubed.
    double volume() const;
    /// A point uniform in the domain; depends only on (index, seed). Any thread.
    Imath::V3d sample(uint64_t index, uint64_t seed) const;
    /// "TetGen, 12345 tetrahedra", or which method replaced TetGen and why.
    const std::string& method() const;
    bool by_tetgen() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace scree
