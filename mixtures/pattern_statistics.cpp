#include "mixtures/pattern_statistics.h"

#include "base/hash.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

namespace scree {

namespace {

struct Bounds {
    Imath::V3d lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
};

/// Bounds of all but stray spheres: one sphere that fell off the table must not make the boxes too wide.
Bounds bounds_of(const ParticleFrame& frame)
{
    constexpr size_t most = 100000;
    const size_t step = 1 + frame.size() / most;
    Bounds b;
    for (int a = 0; a < 3; ++a) {
        std::vector<double> values;
        for (size_t i = 0; i < frame.size(); i += step) values.push_back(frame.position[i][a]);
        std::ranges::sort(values);
        const size_t stray = values.size() / 200;
        b.lo[a] = values[stray];
        b.hi[a] = values[values.size() - 1 - stray];
        const double margin = stray > 0 ? 0.01 * (b.hi[a] - b.lo[a]) : 0;
        b.lo[a] -= margin;
        b.hi[a] += margin;
    }
    return b;
}

int64_t clamped_cell(double x, int64_t count)
{
    return static_cast<int64_t>(std::clamp(x, 0.0, static_cast<double>(count) - 0.5));
}

/// Spheres sorted into the cells of a regular grid over their bounds.
class Cells {
public:
    Cells(const ParticleFrame& frame, const Bounds& bounds, double width) : frame_(frame), lo_(bounds.lo), width_(width)
    {
        for (int a = 0; a < 3; ++a) count_[a] = 1 + static_cast<int64_t>((bounds.hi[a] - bounds.lo[a]) / width);
        starts_.assign(static_cast<size_t>(count_[0] * count_[1] * count_[2]) + 1, 0);
        for (const Imath::V3d& p : frame.position) ++starts_[cell_of(p) + 1];
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        rows_.resize(frame.size());
        std::vector<uint64_t> next(starts_.begin(), starts_.end() - 1);
        for (size_t i = 0; i < frame.size(); ++i) rows_[next[cell_of(frame.position[i])]++] = i;
    }

    /// The sphere, other than `but`, whose centre is nearest to `place`; nothing if none is within a cell's width.
    std::optional<size_t> nearest(const Imath::V3d& place, size_t but) const
    {
        std::optional<size_t> best;
        double least = width_ * width_;
        int64_t c[3];
        for (int a = 0; a < 3; ++a) {
            const double x = (place[a] - lo_[a]) / width_;
            if (!(x > -1 && x < static_cast<double>(count_[a] + 1))) return std::nullopt;
            c[a] = static_cast<int64_t>(std::floor(x));
        }
        for (int64_t z = std::max<int64_t>(c[2] - 1, 0); z <= std::min(c[2] + 1, count_[2] - 1); ++z)
            for (int64_t y = std::max<int64_t>(c[1] - 1, 0); y <= std::min(c[1] + 1, count_[1] - 1); ++y)
                for (int64_t x = std::max<int64_t>(c[0] - 1, 0); x <= std::min(c[0] + 1, count_[0] - 1); ++x) {
                    const auto cell = static_cast<size_t>((z * count_[1] + y) * count_[0] + x);
                    for (uint64_t k = starts_[cell]; k < starts_[cell + 1]; ++k) {
                        const double distance = (frame_.position[rows_[k]] - place).length2();
                        if (distance >= least || rows_[k] == but) continue;
                        least = distance;
                        best = rows_[k];
                    }
                }
        return best;
    }

private:
    size_t cell_of(const Imath::V3d& p) const
    {
        int64_t c[3];
        for (int a = 0; a < 3; ++a) c[a] = clamped_cell((p[a] - lo_[a]) / width_, count_[a]);
        return static_cast<size_t>((c[2] * count_[1] + c[1]) * count_[0] + c[0]);
    }

    const ParticleFrame& frame_;
    Imath::V3d lo_;
    double width_;
    int64_t count_[3];
    std::vector<uint64_t> starts_, rows_;
};

/// The distance between neighbours: the mean diameter, but within 1/4..1 of the edge of a sphere's share of the bounds.
double spacing_of(const ParticleFrame& frame, const Bounds& bounds)
{
    const Imath::V3d extent = bounds.hi - bounds.lo;
    const double size = std::max({extent.x, extent.y, extent.z});
    double radius = 0;
    for (const float r : frame.radius) radius += r / static_cast<double>(frame.size());
    const double least = std::max(2 * radius, size * 1e-4);
    double volume = 1;
    for (int a = 0; a < 3; ++a) volume *= std::max(extent[a], least);
    const double share = std::cbrt(volume / static_cast<double>(frame.size()));
    // Not far below the share, so that there are not many more cells than spheres.
    return std::clamp(2 * radius, share / 4, share);
}

struct Sums {
    std::vector<double> count, volume; // by type
    double all_count = 0, all_volume = 0;
};

/// The ratio of the sums, with its jackknife interval over the boxes that hold spheres.
template <class Part, class All>
FractionEstimate jackknife(const std::vector<Sums>& boxes, const Part& part, const All& all)
{
    double part_sum = 0, all_sum = 0, n = 0;
    for (const Sums& box : boxes) {
        part_sum += part(box);
        all_sum += all(box);
        n += all(box) > 0;
    }
    if (!(all_sum > 0)) return {};
    FractionEstimate estimate;
    estimate.value = part_sum / all_sum;
    double squares = 0;
    for (const Sums& box : boxes) {
        if (!(all(box) > 0) || !(all_sum > all(box))) continue;
        const double without = (part_sum - part(box)) / (all_sum - all(box));
        squares += (without - estimate.value) * (without - estimate.value);
    }
    const double error = n > 1 ? std::sqrt(squares * (n - 1) / n) : 0.5;
    estimate.low = std::max(0.0, estimate.value - 1.96 * error);
    estimate.high = std::min(1.0, estimate.value + 1.96 * error);
    return estimate;
}

void add_fractions(const ParticleFrame& frame, std::span<const uint32_t> types, const Bounds& bounds,
                   PatternStatistics& statistics)
{
    constexpr int edge = 5;
    const size_t n = statistics.types.size();
    std::vector<Sums> boxes(edge * edge * edge);
    for (Sums& box : boxes) {
        box.count.assign(n, 0);
        box.volume.assign(n, 0);
    }
    for (size_t i = 0; i < frame.size(); ++i) {
        int64_t at = 0;
        for (int a = 0; a < 3; ++a) {
            const double extent = bounds.hi[a] - bounds.lo[a];
            const double x = extent > 0 ? edge * (frame.position[i][a] - bounds.lo[a]) / extent : 0;
            at = at * edge + clamped_cell(x, edge);
        }
        const double r = frame.radius[i], volume = 4 * std::numbers::pi / 3 * r * r * r;
        Sums& box = boxes[static_cast<size_t>(at)];
        box.count[types[i]] += 1;
        box.volume[types[i]] += volume;
        box.all_count += 1;
        box.all_volume += volume;
        statistics.types[types[i]].count += 1;
        statistics.types[types[i]].volume += volume;
    }
    for (size_t k = 0; k < n; ++k) {
        PatternStatistics::OfType& type = statistics.types[k];
        type.by_number = jackknife(
            boxes, [k](const Sums& s) { return s.count[k]; }, [](const Sums& s) { return s.all_count; });
        type.by_volume = jackknife(
            boxes, [k](const Sums& s) { return s.volume[k]; }, [](const Sums& s) { return s.all_volume; });
    }
}

void add_correlation(const ParticleFrame& frame, std::span<const uint32_t> types, const Bounds& bounds, size_t tries,
                     PatternStatistics& statistics)
{
    constexpr uint64_t seed = 0x636f7272; // "corr"
    const Imath::V3d extent = bounds.hi - bounds.lo;
    const double spacing = statistics.mean_spacing, farthest = std::max({extent.x, extent.y, extent.z}) / 2;
    double same = 0;
    for (const auto& type : statistics.types) same += type.by_number.value * type.by_number.value;
    if (same >= 1 || !(spacing > 0) || !(farthest > spacing)) return;
    const Cells cells(frame, bounds, spacing);
    constexpr double step = 1.189207115002721; // four shells per factor of 2 in distance
    for (double distance = spacing; distance <= farthest; distance *= step) {
        const uint64_t stream = statistics.correlation.size();
        double pairs = 0, alike = 0, travelled = 0;
        for (size_t t = 0; t < tries; ++t) {
            const auto random = [&](uint64_t k) { return unit_double(hash_index(4 * t + k, seed, stream)); };
            const auto i = static_cast<size_t>(random(0) * static_cast<double>(frame.size()));
            const double z = 2 * random(1) - 1, angle = 2 * std::numbers::pi * random(2), s = std::sqrt(1 - z * z);
            const Imath::V3d place =
                frame.position[i] + distance * Imath::V3d(s * std::cos(angle), s * std::sin(angle), z);
            const auto j = cells.nearest(place, i);
            if (!j) continue;
            pairs += 1;
            alike += types[i] == types[*j];
            travelled += (frame.position[*j] - frame.position[i]).length();
        }
        if (pairs < 200) continue;
        const double p = alike / pairs;
        statistics.correlation.push_back(
            {travelled / pairs, (p - same) / (1 - same), std::sqrt(p * (1 - p) / pairs) / (1 - same)});
    }
    constexpr double target = 1 / std::numbers::e;
    double before_distance = 0, before = 1;
    statistics.correlation_length = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k < statistics.correlation.size(); ++k) {
        const auto& c = statistics.correlation[k];
        if (c.value < target) {
            const double t = (before - target) / (before - c.value);
            const bool none = k == 0 && c.value < 4 * c.standard_error;
            statistics.correlation_length = none ? 0 : before_distance + t * (c.distance - before_distance);
            return;
        }
        before = c.value;
        before_distance = c.distance;
    }
}

} // namespace

PatternStatistics pattern_statistics(const ParticleFrame& frame, std::span<const uint32_t> types, size_t type_count,
                                     size_t pairs)
{
    PatternStatistics statistics;
    statistics.types.resize(type_count);
    statistics.spheres = frame.size();
    if (frame.size() == 0) return statistics;
    const Bounds bounds = bounds_of(frame);
    statistics.mean_spacing = spacing_of(frame, bounds);
    add_fractions(frame, types, bounds, statistics);
    if (pairs > 0) add_correlation(frame, types, bounds, pairs, statistics);
    return statistics;
}

} // namespace scree
