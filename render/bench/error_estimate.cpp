#include "render/bench/error_estimate.h"

#include "render/film/relative_error.h"

#include <limits>

namespace scree {

namespace {

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
    Measured result() const { return {mean_, n_ > 1 ? std::sqrt(m2_ / (n_ - 1) / n_) : 0}; }

private:
    double n_ = 0, mean_ = 0, m2_ = 0;
};

double sum(const V3d& v) { return v.x + v.y + v.z; }

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
                    total += picture.whole(static_cast<size_t>(v) * static_cast<size_t>(picture.width) + static_cast<size_t>(u));
                    ++count;
                }
            }
            around.push_back(count > 0 ? total / count : V3d(0));
        }
    }
    return around;
}

/// As estimate_error says.
Measured squared_bias(const HalfPictures& picture, const HalfPictures& reference)
{
    if (!reference.has_noise()) return {0, std::numeric_limits<double>::infinity()};
    const RelativeError relative(mean_radiance(reference));
    const std::vector<V3d> around = surroundings(reference);
    Mean bias;
    for (size_t p = 0; p < picture.size(); ++p) {
        const V3d r = reference.whole(p);
        bias.add(relative.of(sum((picture.a[p] - r) * (picture.b[p] - r) - reference.noise(p)), around[p]));
    }
    return bias.result();
}

} // namespace

ErrorEstimate estimate_error(const HalfPictures& picture, const HalfPictures& reference)
{
    const V3d truth = mean_radiance(reference);
    const RelativeError relative(truth);
    Mean noise, reference_noise, error;
    V3d difference(0), variance(0);
    for (size_t p = 0; p < picture.size(); ++p) {
        const V3d r = reference.whole(p), of_reference = reference.noise(p), of_picture = picture.noise(p);
        const V3d d = picture.whole(p) - r;
        noise.add(relative.of(sum(of_picture), r));
        reference_noise.add(relative.of(sum(of_reference), r));
        error.add(relative.of(sum(d * d - of_reference), r));
        difference += d;
        variance += of_picture + of_reference;
    }
    ErrorEstimate estimate{noise.result(), squared_bias(picture, reference), squared_bias(reduced(picture, smooth_side), reduced(reference, smooth_side)),
                           reference_noise.result(), error.result(), {}};
    for (int c = 0; c < 3; ++c) {
        const double scale = truth[c] * static_cast<double>(picture.size());
        if (scale > 0) estimate.color[static_cast<size_t>(c)] = {difference[c] / scale, std::sqrt(variance[c]) / scale};
    }
    return estimate;
}

Measured squared_error(const std::vector<V3d>& picture, const HalfPictures& reference)
{
    const RelativeError relative(mean_radiance(reference));
    Mean error;
    for (size_t p = 0; p < picture.size(); ++p) {
        const V3d d = picture[p] - reference.whole(p);
        error.add(relative.of(sum(d * d - reference.noise(p)), reference.whole(p)));
    }
    return error.result();
}

} // namespace scree
