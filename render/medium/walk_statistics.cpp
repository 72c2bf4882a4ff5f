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

void WalkBatch::add(const WalkTrail& trail)
{
    const size_t n = trail.scatterings(), memory = memory_, half = memory_ / 2;
    const auto& p = trail.position;
    scatterings_ += static_cast<double>(n);
    for (size_t i = 0; i < n; ++i) {
        flight_ += trail.flight[i];
        cosine_ += trail.direction[i].dot(trail.direction[i + 1]);
        kept_ += trail.kept[i];
    }
    for (size_t i = 0; i + 1 + memory <= n; ++i) {
        const V3d step = p[i + 1] - p[i];
        const double own = 0.5 * step.length2();
        diffusivity_ += own + step.dot(p[i + 1 + memory] - p[i + 1]);
        half_diffusivity_ += own + step.dot(p[i + 1 + half] - p[i + 1]);
        transport_ += trail.direction[i].dot(p[i + 1 + memory] - p[i]);
        half_transport_ += trail.direction[i].dot(p[i + 1 + half] - p[i]);
        ++windows_;
    }
    for (size_t channel = 0; channel < 3; ++channel) {
        const size_t steps = steps_[channel];
        if (steps == 0) continue;
        const auto keeps = [&](size_t begin, size_t end) {
            double weight = 1;
            for (size_t i = begin; i < end; ++i) weight *= trail.kept[i][static_cast<int>(channel)];
            return weight;
        };
        // Ways that overlap by more than half tell little more.
        for (size_t i = 0; i + 2 * steps <= n; i += steps) {
            const size_t quarter = i + steps / 2, middle = i + steps, end = i + 2 * steps;
            const double first = keeps(i, quarter), second = first * keeps(quarter, middle), all = second * keeps(middle, end);
            const auto length = [&](size_t to) { return static_cast<float>((p[to] - p[i]).length()); };
            ways_[channel].push_back({{length(end), length(middle), length(quarter)},
                                      {static_cast<float>(all), static_cast<float>(second), static_cast<float>(first)}});
        }
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

Measured WalkStatistics::over(double WalkBatch::*sum, double WalkBatch::*count) const
{
    std::vector<double> above, below;
    for (const WalkBatch& batch : batches_) {
        above.push_back(batch.*sum);
        below.push_back(batch.*count);
    }
    return measured_ratio(above, below);
}

PackingDecay WalkStatistics::decay(int channel) const
{
    PackingDecay decay;
    decay.albedo = albedo()[channel];
    decay.steps = batches_.empty() ? 0 : batches_.front().steps_[static_cast<size_t>(channel)];
    if (decay.steps == 0) return decay;
    decay.kappa = decay_between(channel, 0, 1);
    decay.check = decay_between(channel, 1, 2);
    return decay;
}

Measured WalkStatistics::decay_between(int channel, size_t far, size_t near) const
{
    double largest = 0;
    for (const WalkBatch& batch : batches_) {
        for (const auto& way : batch.ways_[static_cast<size_t>(channel)]) largest = std::max<double>(largest, way.length[far]);
    }
    if (largest == 0) return {};
    // Per batch: the excess of the far mean over the near one, and its slope.
    std::vector<double> excess(batches_.size());
    const auto evaluate = [&](double kappa) {
        double sum = 0;
        for (size_t b = 0; b < batches_.size(); ++b) {
            excess[b] = 0;
            for (const auto& way : batches_[b].ways_[static_cast<size_t>(channel)]) {
                excess[b] += way.weight[far] * sinhc(kappa * way.length[far]) - way.weight[near] * sinhc(kappa * way.length[near]);
            }
            sum += excess[b];
        }
        return sum;
    };
    // The excess is convex, and negative at 0. A bracket, then regula falsi (Illinois) in kappa^2, in which it is nearly linear.
    const double at_zero = evaluate(0);
    if (!(at_zero < 0)) return {};
    double low = 0, high = std::pow(1 / largest, 2), at_low = at_zero, at_high = evaluate(std::sqrt(high));
    while (at_high < 0 && std::sqrt(high) * largest < 300) {
        low = high;
        at_low = at_high;
        high *= 2;
        at_high = evaluate(std::sqrt(high));
    }
    double root = high;
    for (int i = 0; i < 30 && high - low > 1e-9 * high; ++i) {
        root = low - at_low * (high - low) / (at_high - at_low);
        const double at = evaluate(std::sqrt(root));
        if (std::abs(at) < -1e-9 * at_zero) break;
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
    const double forgets = std::log(1e-3) / std::log(std::clamp(std::abs(g), 1e-3, 0.999));
    return static_cast<uint32_t>(std::clamp(std::ceil(forgets), 16.0, 256.0));
}

uint32_t decay_steps(double albedo, uint32_t memory)
{
    if (albedo >= 1) return 0;
    const double steps = albedo > 0 ? 1 / -std::log(albedo) : 2;
    return static_cast<uint32_t>(std::clamp(std::round(steps), 4.0, static_cast<double>(memory)));
}

} // namespace scree
