#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <optional>
#include <set>

namespace scree {

/// Decides which grain type each sphere is: a pure, thread-safe function of (sphere index, position).
///
/// Types are numbers into a list of grain types that whoever made the mixture holds.
class Mixture {
public:
    virtual ~Mixture() = default;

    /// The grain type of sphere `index`, whose centre is `position` in the unit of its frame, relative to its origin.
    virtual uint32_t type(uint64_t index, const Imath::V3f& position) const = 0;

    /// Grain types that type() can return, and maybe more; nothing: not known.
    virtual std::optional<std::set<uint32_t>> possible_types() const { return std::nullopt; }
};

} // namespace scree
