#include "render/equivalent/packing_decay.h"

#include <Imath/ImathMatrix.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace scree {

namespace {

using Imath::M33d;
using Imath::V3d;

/// Means over t uniform in -1..1 of t^n exp(x t), n = 0..4.
std::array<double, 5> exponential_moments(double x)
{
    std::array<double, 5> moments{};
    if (x < 0.05) { // the recursion below would cancel
        for (size_t n = 0; n < 5; ++n) {
            const auto m = static_cast<double>(n);
            moments[n] = n % 2 == 0 ? 1 / (m + 1) + x * x * (0.5 / (m + 3) + x * x / (24 * (m + 5)))
                                    : x * (1 / (m + 2) + x * x * (1.0 / 6 / (m + 4) + x * x / (120 * (m + 6))));
        }
        return moments;
    }
    const double over_x = 1 / x, exponential = std::exp(x), up = 0.5 * over_x * exponential,
                 down = 0.5 * over_x / exponential;
    moments[0] = up - down;
    for (size_t n = 1; n < 5; ++n)
        moments[n] = (n % 2 == 0 ? up - down : up + down) - static_cast<double>(n) * over_x * moments[n - 1];
    return moments;
}

/// Adds the mean over rotations of P_k(mu_0) exp(kappa z) P_l(mu_m), times the path's weight.
void add_way(const DecayWay& way, double kappa, M33d& sum)
{
    // The z-axis has the component t along the line of the path and sqrt(1 - t^2) across it, at an azimuth that is
    // averaged over.
    const double a = way.start, b = way.end, d = way.turn - a * b, across_a = 1 - a * a, across_b = 1 - b * b;
    const auto t = exponential_moments(kappa * way.length);
    const double t2s2 = t[2] - t[4], s2 = t[0] - t[2], s4 = t[0] - 2 * t[2] + t[4], ts2 = t[1] - t[3];
    const double a1 = a * t[1], b1 = b * t[1]; // means of mu_0, mu_m
    const double a2 = a * a * t[2] + 0.5 * across_a * s2, b2 = b * b * t[2] + 0.5 * across_b * s2; // mu_0^2, mu_m^2
    const double ab = a * b * t[2] + 0.5 * d * s2; // mu_0 mu_m
    const double ab2 = a * b * b * t[3] + 0.5 * a * across_b * ts2 + b * d * ts2; // mu_0 mu_m^2
    const double a2b = b * a * a * t[3] + 0.5 * b * across_a * ts2 + a * d * ts2; // mu_0^2 mu_m
    const double a2b2 = a * a * b * b * t[4] + 0.5 * (a * a * across_b + b * b * across_a + 4 * a * b * d) * t2s2 +
                        0.125 * (across_a * across_b + 2 * d * d) * s4;
    const double kept = way.kept;
    sum[0][0] += kept * t[0];
    sum[0][1] += kept * b1;
    sum[1][0] += kept * a1;
    sum[1][1] += kept * ab;
    sum[0][2] += kept * (1.5 * b2 - 0.5 * t[0]);
    sum[2][0] += kept * (1.5 * a2 - 0.5 * t[0]);
    sum[1][2] += kept * (1.5 * ab2 - 0.5 * a1);
    sum[2][1] += kept * (1.5 * a2b - 0.5 * b1);
    sum[2][2] += kept * (2.25 * a2b2 - 0.75 * (a2 + b2) + 0.25 * t[0]);
}

/// Largest generalised eigenvalue of A with the Gram matrix diag(1, 1/3, 1/5), and its left and right eigenvectors.
struct Mode {
    double value = 0;
    V3d left{1, 0, 0}, right{1, 0, 0};
};

V3d times(const M33d& a, const V3d& v) { return v * a.transposed(); } // Imath multiplies row vectors from the left

Mode largest_mode(const M33d& a)
{
    Mode mode;
    for (int i = 0; i < 200; ++i) {
        V3d right = times(a, mode.right), left = times(a.transposed(), mode.left);
        right = {right.x, 3 * right.y, 5 * right.z};
        left = {left.x, 3 * left.y, 5 * left.z};
        const double before = mode.value;
        mode.value = right.length() / mode.right.length();
        mode.right = right.normalized();
        mode.left = left.normalized();
        if (std::abs(mode.value - before) <= 1e-12 * mode.value) break;
    }
    return mode;
}

class DecayFit {
public:
    /// thinned: one in this many paths is used.
    DecayFit(std::span<const std::vector<DecayWay>> batches, size_t thinned)
        : batches_(batches), sums_(batches.size()), thinned_(thinned)
    {
        double squares = 0, lost = 0;
        for (const auto& batch : batches_) {
            count_ += used(batch);
            for (size_t i = 0; i < batch.size(); i += thinned_) {
                const DecayWay& way = batch[i];
                longest_ = std::max<double>(longest_, way.length);
                squares += way.kept * way.length * way.length;
                lost += 1 - way.kept;
            }
        }
        if (squares > 0) diffusive2_ = 6 * lost / squares;
    }
    /// An approximate kappa^2 by diffusion, with exp(kappa z) approximated by 1 + kappa^2 r^2 / 6.
    double diffusive2() const { return diffusive2_; }
    double longest() const { return longest_; }

    /// The largest eigenvalue minus 1.
    double excess(double kappa)
    {
        M33d all(0.0);
        for (size_t b = 0; b < batches_.size(); ++b) {
            sums_[b] = M33d(0.0);
            for (size_t i = 0; i < batches_[b].size(); i += thinned_) add_way(batches_[b][i], kappa, sums_[b]);
            all += sums_[b];
        }
        mode_ = largest_mode(all * (1 / count_));
        return mode_.value - 1;
    }
    /// The standard error of the excess at the last kappa.
    double error() const
    {
        const V3d &u = mode_.left, &v = mode_.right;
        const double norm = u.x * v.x + u.y * v.y / 3 + u.z * v.z / 5;
        double residual2 = 0;
        for (size_t b = 0; b < batches_.size(); ++b) {
            const double residual = u.dot(times(sums_[b], v)) / norm - mode_.value * used(batches_[b]);
            residual2 += residual * residual;
        }
        const double n = static_cast<double>(batches_.size());
        return std::sqrt(residual2 * n / (n - 1)) / count_;
    }

private:
    double used(const std::vector<DecayWay>& batch) const
    {
        return static_cast<double>((batch.size() + thinned_ - 1) / thinned_);
    }

    std::span<const std::vector<DecayWay>> batches_;
    std::vector<M33d> sums_;
    size_t thinned_;
    double count_ = 0, longest_ = 0, diffusive2_ = 0;
    Mode mode_;
};

/// The kappa at which the excess is 0; 0 if there is none.
double find_root(DecayFit& fit)
{
    // The excess is negative at 0 and grows. Finds a bracket, then uses regula falsi (Illinois) in kappa^2, in which
    // the excess is nearly linear.
    const double at_zero = fit.excess(0);
    if (!(at_zero < 0) || !(fit.longest() > 0)) return 0;
    double low = 0, high = fit.diffusive2(), at_low = at_zero, at_high = fit.excess(std::sqrt(high));
    while (at_high < 0 && std::sqrt(high) * fit.longest() < 300) {
        low = high;
        at_low = at_high;
        high *= 1.3;
        at_high = fit.excess(std::sqrt(high));
    }
    if (!(at_high >= 0)) return 0;
    double root = high;
    for (int i = 0; i < 40 && high - low > 1e-9 * high; ++i) {
        root = low - at_low * (high - low) / (at_high - at_low);
        const double at = fit.excess(std::sqrt(root));
        if (std::abs(at) < -1e-4 * at_zero) break;
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
    return std::sqrt(root);
}

} // namespace

Measured decay_of_ways(std::span<const std::vector<DecayWay>> batches)
{
    constexpr size_t enough_for_a_start = 8192;
    size_t count = 0;
    for (const auto& batch : batches) count += batch.size();
    // First a root from a part of the paths, then Newton's method with all paths.
    const size_t thinned = std::max<size_t>(1, count / enough_for_a_start);
    DecayFit some(batches, thinned), all(batches, 1);
    double kappa = find_root(some);
    if (kappa == 0 && thinned > 1) kappa = find_root(all);
    if (kappa == 0) return {};
    double slope = 0;
    for (int i = 0; i < 10; ++i) {
        const double above = all.excess(kappa * 1.001), at = all.excess(kappa);
        slope = (above - at) / (0.001 * kappa);
        const double step = std::clamp(at / slope, -0.3 * kappa, 0.3 * kappa);
        kappa -= step;
        // Newton's relative error is about the square of its relative step, and so below the statistical error.
        if (std::abs(step) < 0.01 * kappa) break;
    }
    return {kappa, all.error() / slope};
}

} // namespace scree
