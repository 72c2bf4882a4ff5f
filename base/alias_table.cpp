#include "base/alias_table.h"

namespace scree {

AliasTable::AliasTable(std::span<const double> weights) : slots_(weights.size())
{
    double sum = 0;
    for (const double w : weights) sum += w;
    std::vector<double> share(weights.size(), 1.0); // weight over the mean weight
    if (sum > 0) {
        for (size_t i = 0; i < share.size(); ++i) share[i] = weights[i] / sum * static_cast<double>(weights.size());
    }
    std::vector<uint32_t> small, large;
    for (uint32_t i = 0; i < share.size(); ++i) (share[i] < 1 ? small : large).push_back(i);
    while (!small.empty() && !large.empty()) {
        const uint32_t s = small.back(), l = large.back();
        small.pop_back();
        slots_[s] = {static_cast<float>(share[s]), l};
        share[l] -= 1 - share[s];
        if (share[l] < 1) {
            large.pop_back();
            small.push_back(l);
        }
    }
    // The remaining shares are 1 up to rounding.
    for (const uint32_t i : small) slots_[i] = {1, i};
    for (const uint32_t i : large) slots_[i] = {1, i};
}

} // namespace scree
