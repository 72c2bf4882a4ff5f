#include "packing/tiles/tile_sizes.h"

#include "base/error.h"
#include "base/text.h"
#include "packing/tiles/tile_random.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace scree {

namespace {

const std::string flag = "--sizes";

/// The quantile of the standard normal distribution, by bisection.
double normal_quantile(double p)
{
    double lo = -9, hi = 9;
    for (int k = 0; k < 60; ++k) {
        const double x = (lo + hi) / 2;
        (std::erfc(-x / std::numbers::sqrt2) / 2 < p ? lo : hi) = x;
    }
    return (lo + hi) / 2;
}

double quantile(const TileSizes& sizes, double u)
{
    switch (sizes.kind) {
    case TileSizes::Kind::lognormal: return std::exp(sizes.sigma * normal_quantile(u));
    case TileSizes::Kind::power: {
        const double k = 1 - sizes.exponent;
        if (std::abs(k) < 1e-9) return std::pow(sizes.ratio, u);
        return std::pow(1 + u * (std::pow(sizes.ratio, k) - 1), 1 / k);
    }
    case TileSizes::Kind::sample:
        return sizes
            .radii[std::min(static_cast<size_t>(u * static_cast<double>(sizes.radii.size())), sizes.radii.size() - 1)];
    case TileSizes::Kind::equal:
    case TileSizes::Kind::two: break;
    }
    return 1;
}

/// The given parameters, checked against the parameters of the kind.
class Parameters {
public:
    Parameters(const std::string& kind, std::span<const std::string> words, const std::vector<std::string>& known)
        : kind_(kind)
    {
        for (const std::string& word : words) {
            const size_t equals = word.find('=');
            const std::string name = word.substr(0, equals);
            if (std::ranges::find(known, name) == known.end())
                throw InputError(flag, in_quotes(word),
                                 known.empty() ? kind + " alone"
                                               : fmt::format("for {}: {}", kind, fmt::join(known, "=, ")) + "=" +
                                                     did_you_mean(name, known));
            const auto value =
                equals == std::string::npos ? std::nullopt : to_double(std::string_view(word).substr(equals + 1));
            if (!value || !std::isfinite(*value)) throw InputError(flag, in_quotes(word), name + "=NUMBER");
            if (!values_.emplace(name, *value).second)
                throw InputError(flag, fmt::format("{} twice", name), "each parameter once");
        }
    }
    bool has(const std::string& name) const { return values_.contains(name); }
    double take(const std::string& name, double otherwise, double lo, double hi) const
    {
        const auto found = values_.find(name);
        if (found == values_.end()) return otherwise;
        if (!(found->second >= lo && found->second <= hi))
            throw InputError(flag, fmt::format("{} {}={}", kind_, name, found->second),
                             fmt::format("{} from {} to {}", name, lo, hi));
        return found->second;
    }

private:
    std::string kind_;
    std::map<std::string, double> values_;
};

} // namespace

TileSizes parse_tile_sizes(const std::vector<std::string>& words)
{
    const std::vector<std::string> kinds{"mono", "bidisperse", "lognormal", "power"};
    const std::string kind = words.empty() ? "" : words[0];
    const std::span<const std::string> rest(words.begin() + (words.empty() ? 0 : 1), words.end());
    TileSizes sizes;
    if (kind == "mono") {
        const Parameters none(kind, rest, {});
    } else if (kind == "bidisperse") {
        const Parameters given(kind, rest, {"ratio", "share"});
        sizes.kind = TileSizes::Kind::two;
        sizes.ratio = given.take("ratio", 1.4, 1, 100);
        sizes.share = given.take("share", 0.5, 0, 1);
    } else if (kind == "lognormal") {
        const Parameters given(kind, rest, {"sigma"});
        sizes.kind = TileSizes::Kind::lognormal;
        sizes.sigma = given.take("sigma", 0.3, 0, 1);
    } else if (kind == "power") {
        const Parameters given(kind, rest, {"exponent", "ratio", "min", "max"});
        sizes.kind = TileSizes::Kind::power;
        sizes.exponent = given.take("exponent", 3, -20, 20);
        if (given.has("ratio") && (given.has("min") || given.has("max")))
            throw InputError(flag, "power with ratio and min or max", "ratio=, or min= and max=");
        if (given.has("min") != given.has("max"))
            throw InputError(flag, "power with one of min and max", "both, or ratio=");
        sizes.ratio = given.take("ratio", 10, 1, 100);
        if (given.has("min")) {
            const double min = given.take("min", 1, 1e-300, 1e300);
            sizes.ratio = given.take("max", 1, min, 100 * min) / min;
        }
    } else {
        throw InputError(flag, kind.empty() ? "nothing" : in_quotes(kind),
                         fmt::format("{}{}", fmt::join(kinds, ", "), did_you_mean(kind, kinds)),
                         "radii of a simulation: --radii-from DUMP");
    }
    return sizes;
}

std::string words_of_sizes(const TileSizes& sizes)
{
    switch (sizes.kind) {
    case TileSizes::Kind::equal: return "equal radii";
    case TileSizes::Kind::two:
        return fmt::format("two radii, ratio {:.6g}, the larger {:.4g} % by number", sizes.ratio, 100 * sizes.share);
    case TileSizes::Kind::lognormal: return fmt::format("lognormal radii of sigma {:.6g}", sizes.sigma);
    case TileSizes::Kind::power:
        return fmt::format("radii by the power law r^-{:.6g} over a ratio of {:.6g}", sizes.exponent, sizes.ratio);
    case TileSizes::Kind::sample: return fmt::format("radii drawn from {} given spheres", sizes.radii.size());
    }
    return "";
}

std::vector<double> draw_tile_radii(const TileSizes& sizes, uint64_t count, uint64_t seed)
{
    TileRandom random(seed, 0x73697a6573);
    TileSizes sorted = sizes;
    std::ranges::sort(sorted.radii);
    std::vector<double> radii(count);
    const auto n = static_cast<double>(count);
    const auto larger = static_cast<uint64_t>(std::llround(sizes.share * n));
    for (uint64_t i = 0; i < count; ++i) {
        const double u = (static_cast<double>(i) + random.uniform()) / n;
        radii[i] = sizes.kind == TileSizes::Kind::two ? (i < larger ? sizes.ratio : 1) : quantile(sorted, u);
    }
    for (uint64_t i = count; i > 1; --i) std::swap(radii[i - 1], radii[random.below(i)]);
    const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / n;
    for (double& r : radii) r /= mean;
    return radii;
}

double random_close_packing(std::span<const double> radii)
{
    const auto n = static_cast<double>(radii.size());
    const double mean = std::accumulate(radii.begin(), radii.end(), 0.0) / n;
    double second = 0, third = 0;
    for (const double r : radii) {
        const double x = r / mean - 1;
        second += x * x / n;
        third += x * x * x / n;
    }
    const double delta = std::sqrt(second);
    // S delta^2 is the third moment over delta.
    const double skewed = delta > 1e-9 ? third / delta : 0;
    return std::clamp(0.634 + 0.0658 * delta + 0.0857 * skewed, 0.6, 0.9);
}

} // namespace scree
