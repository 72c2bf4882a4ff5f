#include "mixtures/random_mixture.h"

#include "base/hash.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace scree {

namespace {

double sum_of_weights(std::span<const double> weights)
{
    double sum = 0;
    for (const double w : weights) {
        if (!(w >= 0) || !std::isfinite(w)) throw std::invalid_argument("weights are finite and not below 0");
        sum += w;
    }
    if (!(sum > 0) || !std::isfinite(sum)) throw std::invalid_argument("weights have a finite sum above 0");
    return sum;
}

struct RankedSphere {
    float radius;
    uint32_t hash; // orders spheres of equal radius, so that neither row nor position matters
    uint64_t row;
};

} // namespace

RandomMixture::RandomMixture(std::vector<uint32_t> types, std::span<const double> weights, uint64_t seed,
                             uint64_t stream, SphereIds ids)
    : key_(hash_key(seed, stream)), ids_(std::move(ids))
{
    const double all = sum_of_weights(weights);
    double sum = 0;
    for (size_t k = 0; k < weights.size(); ++k) {
        if (weights[k] == 0) continue; // never chosen, not even where rounding leaves a gap at 1
        if (!types_.empty()) below_.push_back(sum / all);
        sum += weights[k];
        types_.push_back(types[k]);
    }
}

uint32_t RandomMixture::type(uint64_t index, const Imath::V3f&) const
{
    const double u = unit_double(hash_with_key(ids_[index], key_));
    if (below_.size() <= 8) {
        size_t k = 0;
        for (const double b : below_) k += u >= b;
        return types_[k];
    }
    return types_[static_cast<size_t>(std::upper_bound(below_.begin(), below_.end(), u) - below_.begin())];
}

std::vector<uint32_t> choose_by_volume(std::span<const float> radii, const SphereIds& ids,
                                       std::span<const double> weights, uint64_t seed, uint64_t stream)
{
    if (weights.size() > 1024) throw std::invalid_argument("at most 1024 types by volume");
    const double weight_sum = sum_of_weights(weights);
    const uint64_t key = hash_key(seed, stream);
    std::vector<RankedSphere> order(radii.size());
    double all = 0;
    for (size_t i = 0; i < radii.size(); ++i)
        order[i] = {radii[i], static_cast<uint32_t>(hash_with_key(ids[i], key) >> 32), i};
    std::ranges::sort(order, [](const RankedSphere& a, const RankedSphere& b) {
        if (a.radius != b.radius) return a.radius > b.radius;
        return a.hash != b.hash ? a.hash < b.hash : a.row < b.row;
    });
    const double largest = order.empty() || !(order[0].radius > 0) ? 1.0 : order[0].radius;
    const auto volume_of = [&](const RankedSphere& s) {
        const double r = s.radius / largest; // cubes of tiny radii must not underflow
        return r * r * r;
    };
    for (const RankedSphere& s : order) all += volume_of(s);

    const size_t n = weights.size();
    std::vector<double> volume(n, 0), lack(n);
    std::vector<uint32_t> chosen(radii.size());
    double until = 0;
    for (const RankedSphere& s : order) {
        const double v = volume_of(s);
        until += v;
        double sum = 0, most = -std::numeric_limits<double>::infinity();
        size_t emptiest = 0;
        for (size_t k = 0; k < n; ++k) {
            const double w = weights[k] / weight_sum, room = w * all - volume[k];
            const double lacks = w * until - volume[k];
            lack[k] = lacks > 0 && room >= v ? lacks : 0;
            sum += lack[k];
            if (w > 0 && room > most) {
                most = room;
                emptiest = k;
            }
        }
        size_t k = emptiest;
        if (sum > 0) {
            // The low half of the hash, because the high half ordered the spheres.
            double u = sum * 0x1p-32 * static_cast<double>(hash_with_key(ids[s.row], key) & 0xffffffffu);
            for (k = 0; k + 1 < n && (lack[k] == 0 || u >= lack[k]); ++k) u -= lack[k];
            while (lack[k] == 0) --k; // rounding may run past the last type that lacks volume
        }
        volume[k] += v;
        chosen[s.row] = static_cast<uint32_t>(k);
    }
    return chosen;
}

} // namespace scree
