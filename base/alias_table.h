#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Draws indices with probabilities proportional to weights, in constant time (Walker 1977; construction of Vose 1991).
class AliasTable {
public:
    AliasTable() = default;
    /// weights: finite, not negative, at most 2^20 of them; if their sum is 0, all indices are equally likely.
    explicit AliasTable(std::span<const double> weights);

    uint64_t bytes() const { return slots_.size() * sizeof(Slot); }
    /// u: uniform in (0, 1), in steps of 2^-32 or finer.
    uint32_t sample(double u) const
    {
        const double place = u * static_cast<double>(slots_.size());
        const auto slot = static_cast<uint32_t>(place);
        return place - slot < slots_[slot].own ? slot : slots_[slot].other;
    }

private:
    struct Slot {
        float own = 1; ///< probability of the slot's own index; otherwise `other` is drawn
        uint32_t other = 0;
    };
    std::vector<Slot> slots_;
};

} // namespace scree
