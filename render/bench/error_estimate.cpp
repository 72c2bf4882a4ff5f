#include "render/bench/error_estimate.h"

#include "render/film/relative_error.h"

#include <limits>

namespace scree {

namespace {

/// Student's t of the two-sided 95 % interval, by the expansion for many degrees of freedom (Fisher, Cornish 1960);
/// fewer than three count as three.
double student(double freedom)
{
    constexpr double z = 1.959964, z3 = z * z * z, z5 = z3 * z * z;
    const double f = std::max(freedom, 3.0);
    return z + (z3 + z) / (4 * f) + (5 * z5 + 16 * z3 + 3 * z) / (96 * f * f);
}

/// Mean and standard error of values, one a pixel.
class Mean {
public:
    void add(double x)
    {
        ++n_;
        const double delta = x - mean_;
        mean_ += delta / n_;
        m2_ += delta * (x - mean_);
    }
    Measured result() const { return {mean_, n_ > 1 ? std::sqrt(m2_ / (n_ - 1) / n_) : 0, student(n_ - 1)}; }

private:
    double n_ = 0, mean_ = 0, m2_ = 0;
};

/// The mean of the neighbours of each pixel, the pixel itself left out.
std::vector<V3d> surroundings(const HalfPictures& picture)
{
    std::vector<V3d> around;
    around.reserve(picture.size());
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            V3d total(0);
            int count = 0;
            for (int v = std::max(0, y - 1); v <= std::min(picture.height - 1, y + 1); ++v) {
                for (int u = std::max(0, x - 1); u <= std::min(picture.width - 1, x + 1); ++u) {
                    if (u == x && v == y) continue;
                    total += picture.whole(static_cast<size_t>(v) * static_cast<size_t>(picture.width) +
                                           static_cast<size_t>(u));
                    ++count;
                }
            }
            around.push_back(count > 0 ? total / count : V3d(0));
        }
    }
    return around;
}

/// One weight for each pixel, which makes a squared error relative to the reference around the pixel.
std::vector<double> weights_of(const HalfPictures& reference)
{
    const RelativeError relative(mean_radiance(reference));
    std::vector<double> weights;
    weights.reserve(reference.size());
    for (const V3d& around : surroundings(reference)) weights.push_back(relative.of(1, around));
    return weights;
}

/// The mean over pixels of weight times of(pixel). known: whether the noise that `of` uses is known.
template <class Of>
Measured relative_mean(const std::vector<double>& weights, bool known, Of of)
{
    Mean mean;
    for (size_t p = 0; p < weights.size(); ++p) mean.add(weights[p] * of(p));
    Measured result = mean.result();
    if (!known) result.error = std::numeric_limits<double>::infinity();
    return result;
}

/// The squared error at pixel p; the public squared_error is its mean.
double squared_error(const std::vector<std::vector<V3d>>& pictures, const HalfPictures& reference, size_t p)
{
    double squares = 0;
    for (const std::vector<V3d>& picture : pictures) squares += (picture[p] - reference.whole(p)).length2();
    return squares / static_cast<double>(pictures.size()) - channel_sum(reference.noise(p));
}

/// The squared bias by the formula of estimate_error.
Measured squared_bias(const HalfPictures& picture, const HalfPictures& reference, const std::vector<double>& weights)
{
    return relative_mean(weights, reference.has_noise(), [&](size_t p) {
        const V3d r = reference.whole(p);
        return channel_sum((picture.a[p] - r) * (picture.b[p] - r) - reference.noise(p));
    });
}

} // namespace

ErrorEstimate estimate_error(const HalfPictures& picture, const HalfPictures& reference)
{
    const std::vector<double> weights = weights_of(reference);
    const HalfPictures squares = reduced(picture, smooth_side), reference_squares = reduced(reference, smooth_side);
    std::vector<V3d> whole;
    V3d difference(0), variance(0);
    for (size_t p = 0; p < picture.size(); ++p) {
        whole.push_back(picture.whole(p));
        difference += whole[p] - reference.whole(p);
        variance += picture.noise(p) + reference.noise(p);
    }
    ErrorEstimate estimate;
    estimate.noise =
        relative_mean(weights, picture.has_noise(), [&](size_t p) { return channel_sum(picture.noise(p)); });
    estimate.reference_noise =
        relative_mean(weights, reference.has_noise(), [&](size_t p) { return channel_sum(reference.noise(p)); });
    estimate.squared_error = squared_error({whole}, reference);
    estimate.squared_bias = squared_bias(picture, reference, weights);
    estimate.smooth_bias = squared_bias(squares, reference_squares, weights_of(reference_squares));
    const V3d truth = mean_radiance(reference);
    for (int c = 0; c < 3; ++c) {
        const double scale = truth[c] * static_cast<double>(picture.size());
        if (!(scale > 0)) continue;
        const double error =
            reference.has_noise() ? std::sqrt(variance[c]) / scale : std::numeric_limits<double>::infinity();
        estimate.color[static_cast<size_t>(c)] = {difference[c] / scale, error};
    }
    return estimate;
}

Measured squared_error(const std::vector<std::vector<V3d>>& pictures, const HalfPictures& reference)
{
    return relative_mean(weights_of(reference), reference.has_noise(),
                         [&](size_t p) { return squared_error(pictures, reference, p); });
}

Measured part_to_error(const std::vector<std::vector<V3d>>& pictures, const HalfPictures& reference)
{
    const std::vector<double> weights = weights_of(reference);
    const auto noise = [&](size_t p) { return channel_sum(reference.noise(p)); };
    const double variance = relative_mean(weights, true, noise).value;
    const double squared =
        relative_mean(weights, true, [&](size_t p) { return squared_error(pictures, reference, p); }).value;
    const double part = variance / squared;
    // To first order, the contribution of a pixel to the error of the ratio.
    Measured result = relative_mean(weights, reference.has_noise(), [&](size_t p) {
        return (noise(p) - part * squared_error(pictures, reference, p)) / squared;
    });
    result.value = part;
    return result;
}

} // namespace scree
