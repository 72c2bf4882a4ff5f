#include "render/media/phase_function.h"

#include "base/error.h"

#include <fmt/format.h>

namespace scree {

PhaseTable::PhaseTable(const CosineTable& table) : table_(table)
{
    double sum = 0;
    for (uint32_t i = 0; i < CosineTable::bins; ++i) {
        const double mass = table.density[i] * CosineTable::width();
        if (!(mass >= 0))
            throw InputError("phase function", fmt::format("a density of {}", table.density[i]), "0 or more");
        sum += mass;
        cumulated_[i] = sum;
        mean_cosine_ += mass * ((i + 0.5) * CosineTable::width() - 1);
    }
    if (!(std::abs(sum - 1) < 1e-9))
        throw InputError("phase function", fmt::format("a density whose integral is {}", sum), "1");
}

double PhaseTable::sample(double u) const
{
    u *= cumulated_.back();
    const auto bin = std::min<size_t>(static_cast<size_t>(std::ranges::upper_bound(cumulated_, u) - cumulated_.begin()),
                                      CosineTable::bins - 1);
    const double before = bin == 0 ? 0 : cumulated_[bin - 1];
    const double mass = cumulated_[bin] - before, within = mass > 0 ? (u - before) / mass : 0.5;
    return std::clamp((static_cast<double>(bin) + within) * CosineTable::width() - 1, -1.0, 1.0);
}

} // namespace scree
