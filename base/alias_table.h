#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Draws indices by weight in constant time (Walker 1977; made as Vose 1991 does).
class AliasTable {
public:
    AliasTable() = default;
    /// weights: not negative, finite, at most 2^20 of them; with a sum of 0 all are as likely.
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
        float own = 1; ///< chance of the slot's own index; else the other
        uint32_t other = 0;
    };
    std::vector<Slot> slots_;
};

} // namespace scree
