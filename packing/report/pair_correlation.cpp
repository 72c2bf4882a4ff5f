#include "packing/report/pair_correlation.h"

#include "base/hash.h"
#include "packing/report/ordered_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace scree {

using Imath::V3d;

namespace {

constexpr uint64_t choice_seed = 0x63686f69, path_seed = 0x70617468;
constexpr double pair_budget = 8e7, near_budget = 4e7, path_budget = 4e6;
constexpr size_t blocks_per_axis = 4, block_count = blocks_per_axis * blocks_per_axis * blocks_per_axis;
constexpr size_t near_bins = 20;
constexpr double infinity = std::numeric_limits<double>::infinity();

size_t block_of(const PackedSpheres& spheres, uint64_t i)
{
    const V3d u = spheres.fractional(spheres.position(i));
    size_t block = 0;
    for (int axis = 0; axis < 3; ++axis)
        block = block * blocks_per_axis + std::min(static_cast<size_t>(u[axis] * blocks_per_axis), blocks_per_axis - 1);
    return block;
}

/// Mean of (r + s)^3 over the other spheres' radii s.
double mean_cube(double r, const RadiusMoments& m) { return r * r * r + 3 * r * r * m.m[1] + 3 * r * m.m[2] + m.m[3]; }

/// Pair counts in bins of x, and the sum that gives their expectation without correlation, per unit of a bin's shell.
struct Shells {
    std::vector<uint64_t> pairs;
    double cubes = 0; ///< sum of mean_cube over the centres
    uint64_t centres = 0;
    void add(const Shells& other)
    {
        pairs.resize(std::max(pairs.size(), other.pairs.size()));
        for (size_t k = 0; k < other.pairs.size(); ++k) pairs[k] += other.pairs[k];
        cubes += other.cubes;
        centres += other.centres;
    }
};

struct BlockedShells {
    std::array<Shells, block_count> blocks;
    void add(const BlockedShells& other)
    {
        for (size_t b = 0; b < block_count; ++b) blocks[b].add(other.blocks[b]);
    }
};

double shell_volume(double x, double width)
{
    return 4.0 / 3 * std::numbers::pi * (std::pow(x + width, 3) - x * x * x);
}

/// Counts the spheres around sphere i. once: a pair counts twice from its lower index, and not from the other.
void count_around(const PackedSpheres& spheres, uint64_t i, double first, double width, size_t bins, bool once,
                  Shells& shells)
{
    const double r = spheres.radius(i), x_max = first + width * double(bins);
    // If there are far more neighbours than can fit, radii or places are wrong, and the search must end.
    const double expected = 4.0 / 3 * std::numbers::pi * std::pow(x_max, 3) * mean_cube(r, spheres.moments()) *
                            double(spheres.size()) / std::max(spheres.volume(), 1e-300);
    const double most = 5000 + 100 * expected;
    double candidates = 0;
    shells.pairs.resize(bins);
    spheres.visit_near(spheres.position(i), r, x_max, [&](const PackedSpheres::Neighbour& n) {
        const double x = n.offset.length() / (r + n.radius), bin = (x - first) / width;
        const bool itself = x == 0 && n.index == i;
        if (!itself && bin >= 0 && bin < double(bins))
            shells.pairs[static_cast<size_t>(bin)] += !once || n.index == i ? 1 : n.index > i ? 2 : 0;
        return ++candidates < most;
    });
    shells.cubes += mean_cube(r, spheres.moments());
    ++shells.centres;
}

/// The largest x to measure: 5, or less if the packing does not extend that far around at least a tenth of the bulk's
/// spheres.
double choose_x_max(const PackedSpheres& spheres)
{
    if (spheres.container() == PackedSpheres::Container::periodic_box) return 5;
    for (const double x : {5.0, 4.0, 3.0, 2.5, 2.0, 1.5}) {
        const double margin = 2 * x * spheres.largest_radius();
        uint64_t all = 0, deep = 0;
        const uint64_t step = std::max<uint64_t>(1, spheres.size() / 5000);
        for (uint64_t i = 0; i < spheres.size(); i += step) {
            all += spheres.bulk(i);
            deep += spheres.in_bulk(spheres.position(i), margin);
        }
        if (deep > 0 && 10 * deep >= all) return x;
    }
    return 0;
}

/// e^a from a least-squares fit ln g = a + b (x - 1) + c (x - 1)^2, weighted with the counts; 0 if a bin is empty.
double fitted_contact(const Shells& shells, double number_density, double width)
{
    double s[5] = {}, t[3] = {};
    for (size_t k = 0; k < shells.pairs.size(); ++k) {
        const double count = double(shells.pairs[k]), x = 1 + width * double(k);
        if (count < 1) return 0;
        const double y = std::log(count / (number_density * shells.cubes * shell_volume(x, width))),
                     dx = width * (double(k) + 0.5);
        double power = count;
        for (int p = 0; p < 5; ++p, power *= dx) {
            s[p] += power;
            if (p < 3) t[p] += power * y;
        }
    }
    const auto determinant = [](const double(&a)[3], const double(&b)[3], const double(&c)[3]) {
        return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    };
    const double whole = determinant({s[0], s[1], s[2]}, {s[1], s[2], s[3]}, {s[2], s[3], s[4]});
    const double first = determinant({t[0], s[1], s[2]}, {t[1], s[2], s[3]}, {t[2], s[3], s[4]});
    return whole != 0 ? std::exp(first / whole) : 0;
}

/// A value, and its jackknife deviations: one for each block, with that block left out.
struct Replicates {
    double value = 0;
    std::array<double, block_count> deviation{};
    uint64_t used = 0;

    /// Covariance of two values over the same blocks; infinite if there are too few blocks.
    static double covariance(const Replicates& a, const Replicates& b)
    {
        const double n = double(std::min(a.used, b.used));
        if (n < 8) return infinity;
        double sum = 0;
        for (size_t k = 0; k < block_count; ++k) sum += a.deviation[k] * b.deviation[k];
        return sum * (n - 1) * (n - 1) / (n * (n - 2));
    }
    Measured measured() const { return {value, std::sqrt(covariance(*this, *this))}; }
};

/// value(block) is the value without that block; value(block_count) is the value of all blocks.
///
/// A block with more spheres has a higher value. The total number of spheres is given, so this scatter is no error of
/// the total: the part that follows the blocks' counts is removed by regression.
template <class Value>
Replicates jackknife(const std::array<uint64_t, block_count>& counts, const Value& value)
{
    Replicates result;
    result.value = value(block_count);
    for (const uint64_t count : counts) result.used += count > 0;
    const double n = double(result.used);
    std::array<double, block_count> x{}, y{};
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (size_t b = 0; b < block_count; ++b) {
        if (counts[b] == 0) continue;
        x[b] = double(counts[b]);
        y[b] = value(b);
        mean_x += x[b] / n;
        mean_y += y[b] / n;
    }
    for (size_t b = 0; b < block_count; ++b) {
        if (counts[b] == 0) continue;
        xx += (x[b] - mean_x) * (x[b] - mean_x);
        xy += (x[b] - mean_x) * (y[b] - mean_y);
    }
    for (size_t b = 0; b < block_count; ++b)
        if (counts[b] > 0) result.deviation[b] = y[b] - mean_y - (xx > 0 ? xy / xx * (x[b] - mean_x) : 0);
    return result;
}

/// w a + (1 - w) b, with the w of least variance.
Measured combined(const Replicates& a, const Replicates& b)
{
    const double aa = Replicates::covariance(a, a), bb = Replicates::covariance(b, b),
                 ab = Replicates::covariance(a, b);
    if (!(a.value > 0) || !std::isfinite(aa)) return b.measured();
    if (!(b.value > 0) || !std::isfinite(bb)) return a.measured();
    const double spread = aa + bb - 2 * ab, w = spread > 0 ? std::clamp((bb - ab) / spread, 0.0, 1.0) : 0.5;
    return {w * a.value + (1 - w) * b.value, std::sqrt(w * w * aa + (1 - w) * (1 - w) * bb + 2 * w * (1 - w) * ab)};
}

struct PathSums {
    std::array<double, block_count> ends{}, expected{}; ///< sums of (2 / l) (s_1 + s_2) and of 4 pi <s^3>
    std::array<uint64_t, block_count> spheres{};
    double inverse = 0; ///< sum of s / l
    uint64_t paths = 0;
    void add(const PathSums& other)
    {
        for (size_t b = 0; b < block_count; ++b) {
            ends[b] += other.ends[b];
            expected[b] += other.expected[b];
            spheres[b] += other.spheres[b];
        }
        inverse += other.inverse;
        paths += other.paths;
    }
};

/// The first collision of a moving sphere: the distance to it, and the sum of the two radii.
struct Collision {
    double way = infinity, touch = 0;
};

void collide(const V3d& offset, double touch, const V3d& direction, double from, Collision& nearest)
{
    const double b = offset.dot(direction), h2 = touch * touch - (offset.length2() - b * b);
    if (b <= 0 || h2 <= 0) return;
    const double way = b - std::sqrt(h2);
    if (way >= from && way < nearest.way) nearest = {way, touch};
}

/// Finds the nearest collision by marching in steps from the distance `from`; no collision is nearer than `from`.
Collision march(const PackedSpheres& spheres, const V3d& start, double radius, const V3d& direction, double from,
                double step)
{
    Collision nearest;
    for (int k = 0; k < 256 && nearest.way == infinity; ++k, from += step) {
        const V3d middle = start + (from + 0.5 * step) * direction;
        spheres.visit_near(middle, radius + 0.5 * step, 1, [&](const PackedSpheres::Neighbour& n) {
            collide(n.offset + (middle - start), radius + n.radius, direction, from, nearest);
            return true;
        });
        if (nearest.way > from + step) nearest = {}; // beyond this step, a nearer collision may still be unknown
    }
    return nearest;
}

V3d direction_of(uint64_t index)
{
    const double z = 2 * unit_double(hash_index(index, path_seed, 0)) - 1,
                 phi = 2 * std::numbers::pi * unit_double(hash_index(index, path_seed, 1));
    const double s = std::sqrt(std::max(0.0, 1 - z * z));
    return {s * std::cos(phi), s * std::sin(phi), z};
}

/// way: collisions up to this distance are searched among the spheres near i; most paths are shorter.
void free_paths_of(const PackedSpheres& spheres, uint64_t i, uint64_t directions, double way,
                   std::vector<std::pair<V3d, double>>& near, PathSums& sums)
{
    const double r = spheres.radius(i), known = way + r;
    near.clear();
    bool free = true;
    spheres.visit_near(spheres.position(i), known, 1, [&](const PackedSpheres::Neighbour& n) {
        const double d2 = n.offset.length2(), touch = r + n.radius;
        if (d2 == 0 && n.index == i) return true;
        free = free && d2 > touch * touch;
        if (d2 < (known + n.radius) * (known + n.radius)) near.emplace_back(n.offset, touch);
        return free && near.size() < 4096;
    });
    if (!free) return; // overlapping spheres cannot move
    const size_t block = block_of(spheres, i);
    ++sums.spheres[block];
    for (uint64_t k = 0; k < directions; ++k) {
        const V3d u = direction_of(i * directions + k);
        Collision ends[2];
        for (const auto& [offset, touch] : near) {
            const double b = offset.dot(u), h2 = touch * touch - (offset.length2() - b * b);
            if (h2 <= 0) continue;
            const double to = std::abs(b) - std::sqrt(h2);
            Collision& end = ends[b < 0];
            if (to < end.way) end = {to, touch};
        }
        for (int side = 0; side < 2; ++side)
            if (ends[side].way > way) ends[side] = march(spheres, spheres.position(i), r, side == 0 ? u : -u, way, way);
        const double length = ends[0].way + ends[1].way;
        ++sums.paths;
        sums.expected[block] += 4 * std::numbers::pi * mean_cube(r, spheres.moments());
        if (!(length > 0) || length == infinity) continue;
        sums.ends[block] += 2 / length * (ends[0].touch + ends[1].touch);
        sums.inverse += 0.5 * (ends[0].touch + ends[1].touch) / length;
    }
}

} // namespace

PairCorrelation measure_pair_correlation(const PackedSpheres& spheres, double number_density, const Progress& progress)
{
    PairCorrelation result;
    result.x_max = choose_x_max(spheres);
    if (result.x_max == 0 || !(number_density > 0)) return result;
    const double around =
        number_density * 4 / 3 * std::numbers::pi * mean_cube(spheres.moments().m[1], spheres.moments());
    const double margin = 2 * result.x_max * spheres.largest_radius();
    // A sphere is chosen if its hash is below a share of the range: reproducible, and independent of the order in the
    // file.
    const auto chosen = [&](uint64_t i, double share) { return unit_double(hash_index(i, choice_seed)) < share; };
    const auto share_of = [&](double budget, double cost) {
        return budget / (double(spheres.size()) * std::max(cost, 1.0));
    };

    const double share = share_of(pair_budget, around * std::pow(result.x_max, 3));
    const size_t bins = static_cast<size_t>(std::lround(result.x_max / result.bin_width));
    const Shells far =
        ordered_sum<Shells>(spheres.size(), 2048, "pair correlation", progress, [&](uint64_t begin, uint64_t end) {
            Shells part;
            for (uint64_t rank = begin; rank < end; ++rank) {
                const uint64_t i = spheres.ranked(rank);
                if (chosen(i, share) && spheres.in_bulk(spheres.position(i), margin))
                    count_around(spheres, i, 0, result.bin_width, bins, false, part);
            }
            return part;
        });
    result.centres = far.centres;
    if (far.centres == 0) {
        result.x_max = 0;
        return result;
    }
    for (size_t k = 0; k < bins; ++k) {
        const double expected =
            number_density * far.cubes * shell_volume(double(k) * result.bin_width, result.bin_width);
        result.g.push_back(double(far.pairs[k]) / expected);
    }

    const double width = (PairCorrelation::fit_end - 1) / double(near_bins),
                 near_share = share_of(near_budget, 8 * around);
    const double near_margin = 2 * PairCorrelation::fit_end * spheres.largest_radius();
    // A pair across two blocks must not count in both, or the jackknife would miss part of the scatter.
    const bool once = near_share >= 1 && spheres.container() == PackedSpheres::Container::periodic_box;
    const BlockedShells near =
        ordered_sum<BlockedShells>(spheres.size(), 8192, "contact value", progress, [&](uint64_t begin, uint64_t end) {
            BlockedShells part;
            for (uint64_t rank = begin; rank < end; ++rank) {
                const uint64_t i = spheres.ranked(rank);
                if (chosen(i, near_share) && spheres.in_bulk(spheres.position(i), near_margin))
                    count_around(spheres, i, 1, width, near_bins, once, part.blocks[block_of(spheres, i)]);
            }
            return part;
        });
    std::array<uint64_t, block_count> counts{};
    for (size_t b = 0; b < block_count; ++b) counts[b] = near.blocks[b].centres;
    const Replicates fitted = jackknife(counts, [&](size_t without) {
        Shells sum;
        for (size_t b = 0; b < block_count; ++b)
            if (b != without) sum.add(near.blocks[b]);
        if (without == block_count)
            for (const uint64_t ends : sum.pairs) result.fitted_pairs += ends;
        return fitted_contact(sum, number_density, width);
    });
    result.contact = fitted.measured();
    result.fitted_pairs /= 2; // each pair was counted from both ends

    // The mean free path of a sphere in one direction, and the distance searched at once before marching.
    const RadiusMoments& m = spheres.moments();
    const double mean_way = 1 / (number_density * std::numbers::pi * (2 * m.m[2] + 2 * m.m[1] * m.m[1])),
                 spacing = 1 / std::cbrt(number_density);
    const double way = std::min(2 * mean_way, 2 * spacing);
    if (mean_way > 10 * spacing) { // too dilute: free paths are too long, and contacts too rare to matter
        result.best_contact = result.contact;
        return result;
    }
    const double path_cost = std::max(1.0, 4 * mean_way / spacing);
    const uint64_t directions =
        static_cast<uint64_t>(std::clamp(path_budget / path_cost / double(spheres.size()), 4.0, 64.0));
    const double path_share = share_of(path_budget, path_cost * double(directions));
    const PathSums paths =
        ordered_sum<PathSums>(spheres.size(), 2048, "free paths", progress, [&](uint64_t begin, uint64_t end) {
            PathSums part;
            std::vector<std::pair<V3d, double>> buffer;
            for (uint64_t rank = begin; rank < end; ++rank) {
                const uint64_t i = spheres.ranked(rank);
                if (chosen(i, path_share) && spheres.in_bulk(spheres.position(i), near_margin))
                    free_paths_of(spheres, i, directions, way, buffer, part);
            }
            return part;
        });
    result.free_paths = paths.paths;
    const Replicates by_paths = jackknife(paths.spheres, [&](size_t without) {
        double ends = 0, expected = 0;
        for (size_t b = 0; b < block_count; ++b) {
            if (b == without) continue;
            ends += paths.ends[b];
            expected += paths.expected[b];
        }
        return expected > 0 ? ends / (number_density * expected) : 0;
    });
    result.free_path_contact = by_paths.measured();
    result.best_contact = combined(fitted, by_paths);
    result.reduced_pressure = paths.paths > 0 ? 1 + 2.0 / 3 * paths.inverse / double(paths.paths) : 0;
    return result;
}

} // namespace scree
