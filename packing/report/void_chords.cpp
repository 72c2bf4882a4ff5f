#include "packing/report/void_chords.h"

#include "base/hash.h"
#include "packing/report/ordered_sum.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace scree {

using Imath::V3d;

namespace {

constexpr uint64_t line_seed = 0x6c696e65;
constexpr double wanted_entries = 8e5, periods_per_line = 48, most_lines = 4e5;
// A complete chord may start anywhere except in this many expected chords at the end of its line: only longer chords,
// one in 10^5, are lost.
constexpr double reserve = 12;
constexpr size_t density_bins = 80;

struct LineSums {
    double lines = 0, void_length = 0, entries = 0, length = 0, void2 = 0, entries2 = 0, product = 0;
    std::vector<uint64_t> chords = std::vector<uint64_t>(density_bins);
    uint64_t whole = 0;
    void add(const LineSums& o)
    {
        lines += o.lines;
        void_length += o.void_length;
        entries += o.entries;
        length += o.length;
        void2 += o.void2;
        entries2 += o.entries2;
        product += o.product;
        whole += o.whole;
        for (size_t k = 0; k < density_bins; ++k) chords[k] += o.chords[k];
    }
};

using Stretch = std::pair<double, double>; // from, to along the line

/// Finds the stretches of start + t direction, 0 <= t <= length, that lie in spheres, sorted; overlapping stretches are
/// merged.
void solid_stretches(const PackedSpheres& spheres, const V3d& start, const V3d& direction, double length, double step,
                     std::vector<Stretch>& out)
{
    out.clear();
    const double before = spheres.largest_radius(), whole = length + 2 * before;
    const auto steps = static_cast<uint64_t>(std::ceil(whole / step));
    const double width = whole / double(steps);
    for (uint64_t k = 0; k < steps; ++k) {
        const double middle = -before + (double(k) + 0.5) * width;
        spheres.visit_near(start + middle * direction, 0.5 * width, 1, [&](const PackedSpheres::Neighbour& n) {
            // A sphere belongs to the step that contains the line's nearest point to its centre.
            const double nearest = n.offset.dot(direction);
            if (!(nearest >= -0.5 * width && nearest < 0.5 * width)) return true;
            const double h2 = n.radius * n.radius - (n.offset.length2() - nearest * nearest);
            if (h2 <= 0) return true;
            const double half = std::sqrt(h2), t = middle + nearest;
            if (t + half > 0 && t - half < length) out.emplace_back(t - half, t + half);
            return true;
        });
    }
    std::ranges::sort(out);
    size_t last = 0;
    for (size_t i = 1; i < out.size(); ++i) {
        if (out[i].first <= out[last].second)
            out[last].second = std::max(out[last].second, out[i].second);
        else
            out[++last] = out[i];
    }
    if (!out.empty()) out.resize(last + 1);
}

void measure_line(const std::vector<Stretch>& solid, double length, double expected, LineSums& sums)
{
    double void_length = length, entries = 0;
    for (size_t i = 0; i < solid.size(); ++i) {
        const auto& [from, to] = solid[i];
        void_length -= std::min(to, length) - std::max(from, 0.0);
        entries += from > 0;
        if (to >= length - reserve * expected || i + 1 == solid.size()) continue;
        ++sums.whole;
        const double bin = (solid[i + 1].first - to) / (VoidChords::bin_width * expected);
        if (bin < double(density_bins)) ++sums.chords[static_cast<size_t>(bin)];
    }
    ++sums.lines;
    sums.length += length;
    sums.void_length += void_length;
    sums.entries += entries;
    sums.void2 += void_length * void_length;
    sums.entries2 += entries * entries;
    sums.product += void_length * entries;
}

} // namespace

VoidChords measure_void_chords(const PackedSpheres& spheres, const SolidFraction& fraction, const Progress& progress)
{
    VoidChords result;
    if (spheres.container() == PackedSpheres::Container::none || fraction.bulk_spheres == 0) return result;
    if (!(fraction.bulk > 0 && fraction.bulk < 1)) return result;
    const RadiusMoments& m = fraction.bulk_moments;
    result.expected = mean_void_chord(fraction.bulk, m);
    // d ln(chord) / d ln(f) = -1 / (1 - f)
    result.expected_error = result.expected * fraction.bulk_error / (fraction.bulk * (1 - fraction.bulk));
    const double period = result.expected + 4.0 / 3 * m.m[3] / m.m[2], length = periods_per_line * period;
    const double step = std::max(2 * m.m[1], 1 / std::cbrt(fraction.number_density()));
    // For very dilute spheres, fewer lines keep the total number of steps near ten million.
    const double affordable = 1.5e7 / (length / step);
    const auto lines =
        static_cast<uint64_t>(std::clamp(wanted_entries / periods_per_line, 1.0, std::min(most_lines, affordable)));
    // In a mesh or bed most lines are shorter, so more are drawn; lines that start outside the bulk are skipped.
    const bool endless = spheres.container() == PackedSpheres::Container::periodic_box;
    const LineSums sums = ordered_sum<LineSums>(
        endless ? lines : 4 * lines, 128, "void chords", progress, [&](uint64_t begin, uint64_t end) {
            LineSums part;
            std::vector<Stretch> solid;
            for (uint64_t i = begin; i < end; ++i) {
                const V3d start = spheres.sample(i, line_seed);
                if (!spheres.in_bulk(start)) continue;
                const double z = 2 * unit_double(hash_index(i, line_seed, 3)) - 1,
                             phi = 2 * std::numbers::pi * unit_double(hash_index(i, line_seed, 4));
                const double s = std::sqrt(std::max(0.0, 1 - z * z));
                const V3d direction(s * std::cos(phi), s * std::sin(phi), z);
                const double way = spheres.way_in_bulk(start, direction, length);
                if (!(way > 0)) continue;
                solid_stretches(spheres, start, direction, way, step, solid);
                measure_line(solid, way, result.expected, part);
            }
            return part;
        });
    if (sums.lines < 2 || sums.entries < 1) return result;
    result.lines = static_cast<uint64_t>(sums.lines);
    result.entries = static_cast<uint64_t>(sums.entries);
    result.length = sums.length;
    result.solid_part = 1 - sums.void_length / sums.length;
    // The error of a ratio of sums over lines, to first order.
    const double ratio = sums.void_length / sums.entries;
    const double scatter = sums.void2 - 2 * ratio * sums.product + ratio * ratio * sums.entries2;
    result.mean = {ratio, std::sqrt(std::max(0.0, scatter) * sums.lines / (sums.lines - 1)) / sums.entries};
    result.chords = sums.whole;
    for (const uint64_t count : sums.chords)
        result.density.push_back(sums.whole > 0 ? double(count) / (double(sums.whole) * VoidChords::bin_width) : 0);
    return result;
}

} // namespace scree
