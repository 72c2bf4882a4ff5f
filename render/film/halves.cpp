#include "render/film/halves.h"

#include <algorithm>

namespace scree {

void HalfSums::add(const V3d& x)
{
    ++samples;
    sum += x;
    sum_of_squares += x * x;
}

V3d HalfSums::variance() const
{
    if (samples < 2) return V3d(0);
    const double n = samples;
    const V3d m = sum / n, v = (sum_of_squares - m * sum) / (n - 1);
    return {std::max(0.0, v.x), std::max(0.0, v.y), std::max(0.0, v.z)};
}

std::optional<uint32_t> PixelHalves::next(const std::array<uint32_t, 2>& each) const
{
    std::optional<uint32_t> least;
    for (uint32_t h = 0; h < 2; ++h) {
        const uint32_t number = 2 * drawn_[h] + h;
        if (drawn_[h] < each[h] && (!least || number < *least)) least = number;
    }
    return least;
}

void PixelHalves::add(uint32_t number, const Color& radiance, const HalfCounts& counts)
{
    const size_t h = number & 1;
    HalfSums& sums = number / 2 < counts.counts[h] ? halves_[h] : late_;
    sums.add(V3d(radiance.x, radiance.y, radiance.z));
}

HalfSums PixelHalves::judge(int h, const HalfCounts& counts) const
{
    HalfSums sums = half(h);
    if (counts.counts[static_cast<size_t>(h)] == undecided) return sums;
    sums.samples += late_.samples;
    sums.sum += late_.sum;
    sums.sum_of_squares += late_.sum_of_squares;
    return sums;
}

V3d PixelHalves::mean() const
{
    if (halves_[1].samples == 0) return halves_[0].mean();
    if (halves_[0].samples == 0) return halves_[1].mean();
    return 0.5 * (halves_[0].mean() + halves_[1].mean());
}

V3d PixelHalves::variance() const
{
    const auto of_mean = [](const HalfSums& h) { return h.variance() / std::max(1u, h.samples); };
    const HalfSums &a = halves_[0], &b = halves_[1];
    if (b.samples == 0) return of_mean(a);
    if (a.samples == 0) return of_mean(b);
    if (a.samples >= 2 && b.samples >= 2) return 0.25 * (of_mean(a) + of_mean(b));
    // Too few samples to know the spread within each half: the spread of all is used.
    HalfSums all = a;
    all.samples += b.samples;
    all.sum += b.sum;
    all.sum_of_squares += b.sum_of_squares;
    return 0.25 * (1.0 / a.samples + 1.0 / b.samples) * all.variance();
}

} // namespace scree
