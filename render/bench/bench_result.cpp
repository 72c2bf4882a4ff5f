#include "render/bench/bench_result.h"

#include <algorithm>
#include <limits>

namespace scree {

std::optional<Measured> BenchResult::gain(const MethodResult& method) const
{
    const auto ept = std::ranges::find(methods, "ept", &MethodResult::name);
    if (ept == methods.end() || !(method.time_to_unit_variance() > 0)) return std::nullopt;
    if (&*ept == &method) return Measured{1, 0};
    const double ratio = ept->time_to_unit_variance() / method.time_to_unit_variance();
    const auto relative = [](const Measured& m) {
        return m.value > 0 ? m.error / m.value : std::numeric_limits<double>::infinity();
    };
    return Measured{ratio, ratio * std::hypot(relative(ept->estimate.noise), relative(method.estimate.noise))};
}

double BenchResult::processor_share() const
{
    WorkTime all;
    for (const MethodResult& method : methods) all += method.time;
    return all.wall > 0 ? all.processor / (all.wall * std::max(1, machine.threads)) : 0;
}

} // namespace scree
