#include "render/stf/shell_sampler.h"

namespace scree {

namespace {

/// Weights times albedo^events. mean: the weighted mean of albedo^events, exactly 1 at albedo 1, however the sum of
/// the weights is rounded.
template <class Record>
std::vector<double> weigh(const std::vector<Record>& records, const std::vector<float>& weights, double albedo,
                          double& mean)
{
    std::vector<double> weighed(records.size());
    double sum = 0, all = 0;
    for (size_t i = 0; i < records.size(); ++i) {
        weighed[i] = weights[i] * std::pow(albedo, records[i].events);
        sum += weighed[i];
        all += double{weights[i]};
    }
    mean = sum / all;
    return weighed;
}

} // namespace

ShellSampler::ShellSampler(const StfShell& shell, double albedo) : shell_(&shell)
{
    exits_ = AliasTable(weigh(shell.exits, shell.exit_weights, albedo, survival_));
    events_ = AliasTable(weigh(shell.events, shell.event_weights, albedo, event_weight_));
    event_weight_ *= shell.event_sum;
}

} // namespace scree
