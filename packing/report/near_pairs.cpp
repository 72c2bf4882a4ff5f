#include "packing/report/near_pairs.h"

#include "packing/report/ordered_sum.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace scree {

using Imath::V3d;

namespace {

constexpr size_t most_told = 10;
constexpr double largest_gap = 0.31622776601683794; // 10^(-8 + 60/8), in mean radii

/// Volume shared by two balls at distance d.
double lens_volume(double r, double s, double d)
{
    const double small = std::min(r, s);
    if (d <= std::abs(r - s)) return 4.0 / 3 * std::numbers::pi * small * small * small;
    const double depth = r + s - d;
    return std::numbers::pi * depth * depth * (d * d + 2 * d * (r + s) - 3 * (r - s) * (r - s)) / (12 * d);
}

size_t log_bin(double value, double log_first, double per_decade, size_t bins)
{
    const double bin = value > 0 ? std::floor((std::log10(value) - log_first) * per_decade) : 0;
    return static_cast<size_t>(std::clamp(bin, 0.0, double(bins - 1)));
}

struct Part {
    bool complete = true;
    uint64_t overlapping = 0;
    double overlap_sum = 0, lens = 0;
    std::vector<NearPairs::Overlap> worst;
    std::vector<uint64_t> overlap_counts = NearPairs().overlap_counts;
    std::vector<uint64_t> ends_by_gap = std::vector<uint64_t>(61); ///< pair members that are in the bulk, by gap
    std::vector<std::pair<uint64_t, uint64_t>> contacts;
    std::array<double, 6> fabric{};
    uint64_t fabric_count = 0;

    void keep_worst()
    {
        const auto before = [](const NearPairs::Overlap& a, const NearPairs::Overlap& b) {
            if (a.overlap != b.overlap) return a.overlap > b.overlap;
            return std::pair(a.ids[0], a.ids[1]) < std::pair(b.ids[0], b.ids[1]);
        };
        const size_t kept = std::min(worst.size(), most_told);
        std::partial_sort(worst.begin(), worst.begin() + static_cast<std::ptrdiff_t>(kept), worst.end(), before);
        worst.resize(kept);
    }
    void add(const Part& other)
    {
        complete = complete && other.complete;
        overlapping += other.overlapping;
        overlap_sum += other.overlap_sum;
        lens += other.lens;
        worst.insert(worst.end(), other.worst.begin(), other.worst.end());
        keep_worst();
        for (size_t i = 0; i < overlap_counts.size(); ++i) overlap_counts[i] += other.overlap_counts[i];
        for (size_t i = 0; i < ends_by_gap.size(); ++i) ends_by_gap[i] += other.ends_by_gap[i];
        contacts.insert(contacts.end(), other.contacts.begin(), other.contacts.end());
        for (size_t i = 0; i < 6; ++i) fabric[i] += other.fabric[i];
        fabric_count += other.fabric_count;
    }

    void take(const PackedSpheres& spheres, uint64_t i, const PackedSpheres::Neighbour& n,
              const std::vector<uint8_t>& bulk)
    {
        const double r = spheres.radius(i), d = n.offset.length(), touch = r + n.radius, gap = d - touch;
        if (gap < 0) {
            const double overlap = -gap / std::min(r, n.radius);
            ++overlapping;
            overlap_sum += overlap;
            lens += lens_volume(r, n.radius, d);
            ++overlap_counts[log_bin(overlap, NearPairs::log_first, NearPairs::bins_per_decade, overlap_counts.size())];
            const uint64_t a = spheres.id(i), b = spheres.id(n.index);
            worst.push_back({{std::min(a, b), std::max(a, b)}, overlap, spheres.position(i)});
            if (worst.size() > 8 * most_told) keep_worst();
        }
        const double relative = gap / (0.5 * touch);
        const uint64_t ends = uint64_t{bulk[i]} + bulk[n.index];
        // A gap counts from the first tolerance above it.
        const double tolerance =
            relative > 0
                ? std::floor((std::log10(relative) - NearPairs::log_gap_first) * NearPairs::gaps_per_decade) + 1
                : 0;
        if (tolerance < double(ends_by_gap.size())) ends_by_gap[static_cast<size_t>(std::max(tolerance, 0.0))] += ends;
        if (relative >= NearPairs::contact_tolerance) return;
        contacts.emplace_back(i, n.index);
        if (ends == 0 || !(d > 0)) return;
        const V3d u = n.offset / d;
        const double products[6] = {u.x * u.x, u.y * u.y, u.z * u.z, u.x * u.y, u.x * u.z, u.y * u.z};
        for (size_t k = 0; k < 6; ++k) fabric[k] += products[k];
        ++fabric_count;
    }
};

/// Counts contacts, and finds the spheres that remain when spheres with fewer than four contacts are removed
/// repeatedly.
void count_contacts(const std::vector<std::pair<uint64_t, uint64_t>>& contacts, const std::vector<uint8_t>& bulk,
                    NearPairs& result)
{
    const size_t n = bulk.size();
    std::vector<uint64_t> start(n + 1, 0);
    for (const auto& [a, b] : contacts) {
        ++start[a + 1];
        ++start[b + 1];
    }
    for (size_t i = 0; i < n; ++i) start[i + 1] += start[i];
    std::vector<uint64_t> other(2 * contacts.size()), next(start.begin(), start.end() - 1);
    for (const auto& [a, b] : contacts) {
        other[next[a]++] = b;
        other[next[b]++] = a;
    }
    std::vector<uint64_t> count(n), leaving;
    uint64_t sum = 0;
    for (size_t i = 0; i < n; ++i) {
        count[i] = start[i + 1] - start[i];
        if (!bulk[i]) continue;
        sum += count[i];
        if (count[i] >= result.contact_counts.size()) result.contact_counts.resize(count[i] + 1);
        ++result.contact_counts[count[i]];
        if (count[i] < 4) leaving.push_back(i);
    }
    result.mean_contacts = result.bulk_spheres > 0 ? double(sum) / double(result.bulk_spheres) : 0;
    std::vector<uint8_t> gone(n);
    while (!leaving.empty()) {
        const uint64_t i = leaving.back();
        leaving.pop_back();
        if (gone[i]) continue;
        gone[i] = 1;
        ++result.rattlers;
        for (uint64_t k = start[i]; k < start[i + 1]; ++k) {
            const uint64_t j = other[k];
            --count[j];
            if (bulk[j] && !gone[j] && count[j] < 4) leaving.push_back(j);
        }
    }
    sum = 0;
    for (size_t i = 0; i < n; ++i)
        if (bulk[i] && !gone[i]) sum += count[i];
    const uint64_t left = result.bulk_spheres - result.rattlers;
    result.mean_contacts_without_rattlers = left > 0 ? double(sum) / double(left) : 0;
}

} // namespace

FabricTensor fabric_of(const std::array<double, 6>& sums, uint64_t directions)
{
    FabricTensor result;
    result.directions = directions;
    if (directions == 0) return result;
    for (size_t k = 0; k < 6; ++k) result.tensor[k] = sums[k] / double(directions);
    const auto& [xx, yy, zz, xy, xz, yz] = result.tensor;
    double m[3][3] = {{xx - 1.0 / 3, xy, xz}, {xy, yy - 1.0 / 3, yz}, {xz, yz, zz - 1.0 / 3}};
    double norm2 = 0;
    for (const auto& row : m)
        for (const double x : row) norm2 += x * x;
    result.deviatoric = std::sqrt(1.5 * norm2);
    // Jacobi rotations also work for equal eigenvalues, which isotropic tensors have.
    for (int sweep = 0; sweep < 8; ++sweep)
        for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
            if (m[p][q] == 0) continue;
            const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]),
                         t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
            const double c = 1 / std::sqrt(t * t + 1), s = t * c;
            for (int k = 0; k < 3; ++k) {
                const double a = m[k][p], b = m[k][q];
                m[k][p] = c * a - s * b;
                m[k][q] = s * a + c * b;
            }
            for (int k = 0; k < 3; ++k) {
                const double a = m[p][k], b = m[q][k];
                m[p][k] = c * a - s * b;
                m[q][k] = s * a + c * b;
            }
        }
    for (int k = 0; k < 3; ++k) result.eigenvalues[static_cast<size_t>(k)] = m[k][k] + 1.0 / 3;
    std::ranges::sort(result.eigenvalues, std::greater<>());
    return result;
}

NearPairs measure_near_pairs(const PackedSpheres& spheres, const Progress& progress)
{
    const bool all = spheres.container() == PackedSpheres::Container::none;
    std::vector<uint8_t> bulk(spheres.size());
    for (uint64_t i = 0; i < spheres.size(); ++i) bulk[i] = all || spheres.bulk(i);
    const Part sum =
        ordered_sum<Part>(spheres.size(), 4096, "overlaps and contacts", progress, [&](uint64_t begin, uint64_t end) {
            Part part;
            for (uint64_t rank = begin; rank < end; ++rank) {
                const uint64_t i = spheres.ranked(rank);
                const bool done =
                    spheres.visit_pairs(rank, 1 + 0.5 * largest_gap,
                                        [&](const PackedSpheres::Neighbour& n) { part.take(spheres, i, n, bulk); });
                part.complete = part.complete && done;
            }
            part.keep_worst();
            return part;
        });

    NearPairs result;
    result.complete = sum.complete;
    result.overlapping = sum.overlapping;
    result.mean_overlap = sum.overlapping > 0 ? sum.overlap_sum / double(sum.overlapping) : 0;
    result.lens_volume = sum.lens;
    result.worst = sum.worst;
    result.overlap_counts = sum.overlap_counts;
    result.bulk_spheres = static_cast<uint64_t>(std::count(bulk.begin(), bulk.end(), uint8_t{1}));
    uint64_t below = 0;
    for (size_t k = 0; k < sum.ends_by_gap.size(); ++k) {
        below += sum.ends_by_gap[k];
        result.contacts_below_gap[k] = result.bulk_spheres > 0 ? double(below) / double(result.bulk_spheres) : 0;
    }
    count_contacts(sum.contacts, bulk, result);
    result.fabric = fabric_of(sum.fabric, sum.fabric_count);
    return result;
}

} // namespace scree
