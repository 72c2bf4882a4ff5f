#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <optional>
#include <set>

namespace scree {

/// Decides the grain type of each sphere: a pure, thread-safe function of (sphere index, position).
///
/// Types are indices into a list of grain types, which the code that made the mixture keeps.
class Mixture {
public:
    virtual ~Mixture() = default;

    /// The grain type of sphere `index`; position: its centre in the frame's unit, relative to the frame's origin.
    virtual uint32_t type(uint64_t index, const Imath::V3f& position) const = 0;

    /// A set that contains all grain types that type() can return; nothing: not known.
    virtual std::optional<std::set<uint32_t>> possible_types() const { return std::nullopt; }
};

} // namespace scree
