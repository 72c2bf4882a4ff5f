#include "render/stress/stress_comparison.h"

#include <fmt/format.h>

#include <cstring>
#include <functional>

namespace scree {

namespace {

constexpr double rounding = 2e-6; // relative: pixels without noise still differ by the rounding of float sums

/// A mean and its variance.
struct Mean {
    double value = 0, variance = 0;
};

using PixelMean = std::function<Mean(int x, int y, int channel)>;

Mean pixel_mean(const Film& film, int x, int y, int channel)
{
    const Pixel& pixel = film.at(x, y);
    if (pixel.samples < 2) return {0, std::numeric_limits<double>::infinity()};
    const double n = pixel.samples, mean = pixel.sum[channel] / n;
    return {mean, std::max(0.0, pixel.sum_of_squares[channel] / n - mean * mean) / (n - 1)};
}

Mean mean_over(const PixelMean& of, int x0, int y0, int x1, int y1, int channel)
{
    Mean sum;
    for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
            const Mean m = of(x, y, channel);
            sum.value += m.value;
            sum.variance += m.variance;
        }
    }
    const double n = static_cast<double>(x1 - x0) * (y1 - y0);
    return {sum.value / n, sum.variance / (n * n)};
}

/// samples: of a pixel, if b is a known truth; so few samples may have missed rare events of a radiance up to 1.
StressFinding compare(const PixelMean& a, const PixelMean& b, int width, int height, int block, double bias,
                      double samples = std::numeric_limits<double>::infinity())
{
    StressFinding finding;
    finding.unit = "sigma";
    int tests = 0;
    double whole_error = 0, whole_unseen = 0, whole_difference = 0;
    std::string where;
    const auto test = [&](int x0, int y0, int x1, int y1, int channel) {
        const Mean ma = mean_over(a, x0, y0, x1, y1, channel), mb = mean_over(b, x0, y0, x1, y1, channel);
        const double scale = std::max(std::abs(ma.value), std::abs(mb.value)),
                     error = std::sqrt(ma.variance + mb.variance);
        const double unseen = 1 / (samples * (x1 - x0) * (y1 - y0));
        const double difference = std::max(0.0, std::abs(ma.value - mb.value) - (bias + rounding) * scale - unseen);
        const double z = difference > 0 ? difference / error : 0;
        ++tests;
        if (!(z <= finding.deviation)) {
            finding.deviation = z;
            where = fmt::format("{} {:.5g} against {:.5g} at {},{}..{},{}", "RGB"[channel], ma.value, mb.value, x0, y0,
                                x1, y1);
        }
        if (x1 - x0 == width && y1 - y0 == height && scale > 0) {
            whole_error = std::max(whole_error, error / scale);
            whole_unseen = std::max(whole_unseen, unseen / scale);
            whole_difference = std::max(whole_difference, std::abs(ma.value - mb.value) / scale);
        }
    };
    for (int channel = 0; channel < 3; ++channel) {
        test(0, 0, width, height, channel);
        for (int y = 0; y + block <= height; y += block) {
            for (int x = 0; x + block <= width; x += block) test(x, y, x + block, y + block, channel);
        }
    }
    finding.allowed = critical_z(stress_level, tests);
    constexpr double nine_in_ten = 1.2816;
    finding.sees = bias + whole_unseen + (finding.allowed + nine_in_ten) * whole_error;
    finding.remark = fmt::format("whole picture off by {:.2g} %", 100 * whole_difference);
    if (finding.deviation > finding.allowed) finding.remark += "; " + where;
    return finding;
}

PixelMean means_of(const Film& film)
{
    return [&film](int x, int y, int channel) { return pixel_mean(film, x, y, channel); };
}

} // namespace

double critical_z(double level, int tests)
{
    const double each = -std::expm1(std::log1p(-level) / tests);
    double lo = 0, hi = 40;
    for (int i = 0; i < 80; ++i) {
        const double z = 0.5 * (lo + hi);
        (std::erfc(z * std::numbers::sqrt2 / 2) > each ? lo : hi) = z;
    }
    return hi;
}

StressFinding compare_means(const Film& a, const Film& b, int block, double bias)
{
    return compare(means_of(a), means_of(b), a.width(), a.height(), block, bias);
}

StressFinding compare_truth(const Film& a, const std::vector<double>& truth, int block, double bias)
{
    const auto exact = [&](int x, int y, int) {
        return Mean{truth[static_cast<size_t>(y) * static_cast<size_t>(a.width()) + static_cast<size_t>(x)], 0};
    };
    return compare(means_of(a), exact, a.width(), a.height(), block, bias, a.at(0, 0).samples);
}

StressFinding compare_loss(const Film& a, double loss, double bias)
{
    const auto lost = [&a](int x, int y, int channel) {
        const Mean m = pixel_mean(a, x, y, channel);
        return Mean{1 - m.value, m.variance};
    };
    const auto exact = [&](int, int, int) { return Mean{loss, 0}; };
    return compare(lost, exact, a.width(), a.height(), std::max(a.width(), a.height()), bias, a.at(0, 0).samples);
}

StressFinding compare_bits(const Film& a, const Film& b)
{
    StressFinding finding;
    finding.unit = "pixels";
    double largest = 0;
    for (size_t i = 0; i < a.pixels().size(); ++i) {
        const Pixel& p = a.pixels()[i];
        const Pixel& q = b.pixels()[i];
        const auto same = [](const auto& u, const auto& v) { return std::memcmp(&u, &v, sizeof u) == 0; };
        const bool equal = p.samples == q.samples && p.hits == q.hits && p.id == q.id && p.type == q.type &&
                           same(p.sum, q.sum) && same(p.sum_of_squares, q.sum_of_squares) && same(p.albedo, q.albedo) &&
                           same(p.normal, q.normal) && same(p.depth, q.depth);
        finding.deviation += !equal;
        largest = std::max(largest, (p.sum - q.sum).length() / std::max(1e-300, q.sum.length()));
    }
    if (finding.deviation > 0)
        finding.remark = fmt::format("of {} pixels; radiance off by up to {:.2g} relative", a.pixels().size(), largest);
    return finding;
}

StressFinding compare_exactly(const Film& a, double truth, double allowed)
{
    StressFinding finding;
    finding.unit = "absolute";
    finding.allowed = allowed;
    for (const Pixel& pixel : a.pixels()) {
        for (int channel = 0; channel < 3; ++channel) {
            const double off = pixel.samples > 0 ? std::abs(pixel.sum[channel] / pixel.samples - truth)
                                                 : std::numeric_limits<double>::infinity();
            finding.deviation = std::max(finding.deviation, off);
        }
    }
    return finding;
}

} // namespace scree
