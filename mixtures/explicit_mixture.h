#pragma once

#include "ingest/particles/particle_frame.h"
#include "mixtures/mixture.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace scree {

/// A list with the grain type of every sphere, e.g. from a simulation; one byte per sphere for up to 256 types.
class ExplicitMixture final : public Mixture {
public:
    /// types[i] is the type of sphere i; all below 65536.
    explicit ExplicitMixture(const std::vector<uint32_t>& types);
    explicit ExplicitMixture(std::vector<uint8_t> types) : narrow_(std::move(types)) {}

    uint32_t type(uint64_t index, const Imath::V3f&) const override
    {
        return wide_.empty() ? narrow_[index] : wide_[index];
    }
    std::optional<std::set<uint32_t>> possible_types() const override;
    uint64_t size() const { return wide_.empty() ? narrow_.size() : wide_.size(); }

private:
    std::vector<uint8_t> narrow_; // used when every type is below 256
    std::vector<uint16_t> wide_; // used otherwise
};

/// The explicit mixture of a frame: `type_map` maps the frame's own type numbers to grain types.
///
/// Throws InputError naming `place` when a sphere has a type that the map lacks.
std::unique_ptr<ExplicitMixture> mixture_from_frame(const ParticleFrame& frame,
                                                    const std::map<int32_t, uint32_t>& type_map,
                                                    const std::string& place);

} // namespace scree
