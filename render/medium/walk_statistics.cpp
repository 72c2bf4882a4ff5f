#include "render/medium/walk_statistics.h"

namespace scree {

namespace {

/// sinh(x) / x.
double sinhc(double x)
{
    if (x < 1e-2) return 1 + x * x / 6 * (1 + x * x / 20);
    const double e = std::exp(x);
    return 0.5 * (e - 1 / e) / x;
}

} // namespace

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
    for (size_t i = 0; i < above.size(); ++i) residual2 += (above[i] - ratio * below[i]) * (above[i] - ratio * below[i]);
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
        nodes_.push_back({V3f(trail.position[i] - trail.position[0]), {static_cast<float>(kept.x), static_cast<float>(kept.y), static_cast<float>(kept.z)}});
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
        // The last term is zero over all batches, and brings in how l* itself scatters.
        const double of_l = (sums.transport - l * (sums.count - sums.direction)) * all.last / (all.count - all.direction);
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
    const uint32_t longest = 2 * (batches_.empty() ? 0 : batches_.front().memory_);
    // Of light dimmed by so much that it matters and so little that it can be counted.
    const double steps = 0.5 / -std::log(std::max(decay.albedo, 1e-6));
    decay.steps = static_cast<uint32_t>(std::clamp(std::round(steps), 2.0, static_cast<double>(longest)));
    decay.kappa = decay_of_steps(channel, decay.steps);
    while (2 * decay.steps <= longest) {
        const Measured next = decay_of_steps(channel, 2 * decay.steps);
        const bool agrees = std::abs(next.value - decay.kappa.value) <= next.error, known = next.error < 0.03 * next.value;
        if (!known) break;
        decay.check = decay.kappa;
        decay.kappa = next;
        decay.steps *= 2;
        if (agrees) break;
    }
    return decay;
}

Measured WalkStatistics::decay_of_steps(int channel, uint32_t steps) const
{
    // A way of 2 n scatterings and the first half of it.
    struct Way {
        float near, far, near_kept, far_kept;
    };
    const auto c = static_cast<size_t>(channel);
    std::vector<std::vector<Way>> ways(batches_.size());
    double largest = 0;
    for (size_t b = 0; b < batches_.size(); ++b) {
        const auto& nodes = batches_[b].nodes_;
        const auto& walks = batches_[b].walks_;
        for (size_t walk = 0; walk < walks.size(); ++walk) {
            const size_t end = walk + 1 < walks.size() ? walks[walk + 1] : nodes.size();
            // Ways that overlap by more than half tell little more.
            for (size_t i = walks[walk]; i + 2 * steps < end; i += steps) {
                const auto &from = nodes[i], &near = nodes[i + steps], &far = nodes[i + 2 * steps];
                ways[b].push_back({(near.position - from.position).length(), (far.position - from.position).length(),
                                   std::exp(near.kept[c] - from.kept[c]), std::exp(far.kept[c] - from.kept[c])});
                largest = std::max<double>(largest, ways[b].back().far);
            }
        }
    }
    if (largest == 0) return {};
    std::vector<double> excess(batches_.size()); // of the far sum over the near one, per batch
    const auto evaluate = [&](double kappa) {
        double sum = 0;
        for (size_t b = 0; b < ways.size(); ++b) {
            excess[b] = 0;
            for (const Way& way : ways[b]) excess[b] += way.far_kept * sinhc(kappa * way.far) - way.near_kept * sinhc(kappa * way.near);
            sum += excess[b];
        }
        return sum;
    };
    // The excess is negative at 0 and grows. A bracket, then regula falsi (Illinois) in kappa^2, in which it is nearly linear.
    const double at_zero = evaluate(0);
    if (!(at_zero < 0)) return {};
    double low = 0, high = std::pow(1 / largest, 2), at_low = at_zero, at_high = evaluate(std::sqrt(high));
    while (at_high < 0 && std::sqrt(high) * largest < 300) {
        low = high;
        at_low = at_high;
        high *= 4;
        at_high = evaluate(std::sqrt(high));
    }
    if (at_high < 0) return {};
    double root = high;
    for (int i = 0; i < 40 && high - low > 1e-9 * high; ++i) {
        root = low - at_low * (high - low) / (at_high - at_low);
        const double at = evaluate(std::sqrt(root));
        if (std::abs(at) < -1e-7 * at_zero) break;
        if (at < 0) {
            low = root;
            at_low = at;
            at_high *= 0.5;
        } else {
            high = root;
            at_high = at;
            at_low *= 0.5;
        }
    }
    const double kappa = std::sqrt(root), above = evaluate(kappa * 1.001), slope = (above - evaluate(kappa)) / (0.001 * kappa);
    double residual2 = 0;
    for (const double x : excess) residual2 += x * x;
    const double n = static_cast<double>(batches_.size());
    return {kappa, std::sqrt(residual2 * n / (n - 1)) / slope};
}

uint32_t walk_memory(double g)
{
    const double forgets = std::log(0.01) / std::log(std::clamp(std::abs(g), 1e-3, 0.999));
    return static_cast<uint32_t>(std::clamp(std::ceil(forgets), 12.0, 256.0));
}

} // namespace scree
