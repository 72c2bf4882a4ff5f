#include "render/equivalent/walk_statistics.h"

namespace scree {

Measured measured_ratio(std::span<const double> above, std::span<const double> below)
{
    const double n = static_cast<double>(above.size());
    double all_above = 0, all_below = 0;
    for (size_t i = 0; i < above.size(); ++i) {
        all_above += above[i];
        all_below += below[i];
    }
    if (all_below == 0) return {};
    const double ratio = all_above / all_below;
    double residual2 = 0;
    for (size_t i = 0; i < above.size(); ++i)
        residual2 += (above[i] - ratio * below[i]) * (above[i] - ratio * below[i]);
    return {ratio, n > 1 ? std::sqrt(residual2 * n / (n - 1)) / std::abs(all_below) : 0};
}

void WalkTrail::clear()
{
    position.clear();
    direction.clear();
    kept.clear();
    flight.clear();
}

void WalkBatch::add_window(Windows& windows, const WalkTrail& trail, size_t i, size_t memory)
{
    const auto& p = trail.position;
    const V3d& w = trail.direction[i];
    const V3d step = p[i + 1] - p[i];
    ++windows.count;
    windows.transport += w.dot(p[i + memory] - p[i]);
    windows.direction += w.dot(trail.direction[i + memory]);
    windows.own += 0.5 * step.length2();
    windows.later += step.dot(p[i + 1 + memory] - p[i + 1]);
    windows.last += step.dot(trail.direction[i + 1 + memory]);
}

void WalkBatch::add(const WalkTrail& trail)
{
    const size_t n = trail.scatterings(), half = std::max(1u, memory_ / 2);
    scatterings_ += static_cast<double>(n);
    for (size_t i = 0; i < n; ++i) {
        flight_ += trail.flight[i];
        cosine_ += trail.direction[i].dot(trail.direction[i + 1]);
        kept_ += trail.kept[i];
    }
    for (size_t i = 0; i + 1 + memory_ <= n; ++i) {
        add_window(windows_, trail, i, memory_);
        add_window(half_, trail, i, half);
    }
    walks_.push_back(nodes_.size());
    V3d kept(0);
    for (size_t i = 0; i <= n; ++i) {
        nodes_.push_back({V3f(trail.position[i] - trail.position[0]),
                          V3f(trail.direction[i]),
                          {static_cast<float>(kept.x), static_cast<float>(kept.y), static_cast<float>(kept.z)}});
        if (i == n) break;
        for (int c = 0; c < 3; ++c) kept[c] += std::log(std::max(trail.kept[i][c], 1e-30));
    }
}

uint64_t WalkStatistics::scatterings() const
{
    double sum = 0;
    for (const WalkBatch& batch : batches_) sum += batch.scatterings_;
    return static_cast<uint64_t>(sum);
}

V3d WalkStatistics::albedo() const
{
    V3d kept(0);
    double count = 0;
    for (const WalkBatch& batch : batches_) {
        kept += batch.kept_;
        count += batch.scatterings_;
    }
    return count > 0 ? kept / count : V3d(1);
}

Measured WalkStatistics::over_scatterings(double WalkBatch::*sum) const
{
    std::vector<double> above, below;
    for (const WalkBatch& batch : batches_) {
        above.push_back(batch.*sum);
        below.push_back(batch.scatterings_);
    }
    return measured_ratio(above, below);
}

Measured WalkStatistics::transport_length(Windows WalkBatch::*windows) const
{
    std::vector<double> above, below;
    for (const WalkBatch& batch : batches_) {
        const Windows& sums = batch.*windows;
        above.push_back(sums.transport);
        below.push_back(sums.count - sums.direction);
    }
    return measured_ratio(above, below);
}

Measured WalkStatistics::diffusivity(Windows WalkBatch::*windows) const
{
    Windows all;
    for (const WalkBatch& batch : batches_) {
        const Windows& sums = batch.*windows;
        all.count += sums.count;
        all.direction += sums.direction;
        all.last += sums.last;
    }
    const double l = transport_length(windows).value;
    std::vector<double> above, below;
    for (const WalkBatch& batch : batches_) {
        const Windows& sums = batch.*windows;
        // The last term sums to zero over all batches; it adds the statistical error of l*.
        const double of_l =
            (sums.transport - l * (sums.count - sums.direction)) * all.last / (all.count - all.direction);
        above.push_back(sums.own + sums.later + l * sums.last + of_l);
        below.push_back(sums.count);
    }
    return measured_ratio(above, below);
}

PackingDecay WalkStatistics::decay(int channel) const
{
    PackingDecay decay;
    decay.albedo = albedo()[channel];
    if (decay.albedo >= 1) return decay;
    const uint32_t longest = batches_.empty() ? 0 : 2 * batches_.front().memory_;
    // Paths must be long enough for their loss to be measurable. With too many scatterings the result depends on the
    // few paths that lead far.
    const double per_step = -std::log(std::max(decay.albedo, 1e-6)),
                 most = std::min<double>(longest, std::max(4.0, 2.5 / per_step));
    decay.steps = static_cast<uint32_t>(std::clamp(std::round(0.25 / per_step), 2.0, 0.5 * most));
    decay.check = decay_of_steps(channel, decay.steps);
    decay.steps *= 2;
    decay.kappa = decay_of_steps(channel, decay.steps);
    while (2 * decay.steps <= most && std::abs(decay.kappa.value - decay.check.value) > 2 * decay.kappa.error) {
        const Measured next = decay_of_steps(channel, 2 * decay.steps);
        if (!(next.error < 0.015 * next.value)) break;
        decay.check = decay.kappa;
        decay.kappa = next;
        decay.steps *= 2;
    }
    return decay;
}

Measured WalkStatistics::decay_of_steps(int channel, uint32_t steps) const
{
    const auto c = static_cast<size_t>(channel);
    std::vector<std::vector<DecayWay>> ways(batches_.size());
    for (size_t b = 0; b < batches_.size(); ++b) {
        const auto& nodes = batches_[b].nodes_;
        const auto& walks = batches_[b].walks_;
        for (size_t walk = 0; walk < walks.size(); ++walk) {
            const size_t end = walk + 1 < walks.size() ? walks[walk + 1] : nodes.size();
            for (size_t i = walks[walk]; i + steps < end; i += std::max(1u, steps / 2)) {
                const auto &from = nodes[i], &to = nodes[i + steps];
                const V3f way = to.position - from.position, along = way.normalized();
                ways[b].push_back({way.length(), along.dot(from.direction), along.dot(to.direction),
                                   from.direction.dot(to.direction), std::exp(to.kept[c] - from.kept[c])});
            }
        }
    }
    return decay_of_ways(ways);
}

uint32_t walk_memory(double g)
{
    const double forgets = std::log(0.01) / std::log(std::clamp(std::abs(g), 1e-3, 0.999));
    return static_cast<uint32_t>(std::clamp(std::ceil(forgets), 12.0, 256.0));
}

} // namespace scree
