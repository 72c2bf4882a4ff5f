#include "packing/report/bond_order.h"

#include "packing/report/ordered_sum.h"
#include "packing/report/packed_spheres.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

namespace scree {

using Imath::V3d;

namespace {

constexpr uint64_t most_spheres = 1'000'000;
constexpr double reach_in_spacings = 1.4, solid_agreement = 0.7;
constexpr size_t solid_bonds = 7, fewest_bonds = 6;

using Harmonics4 = std::array<std::complex<double>, 5>; // m = 0..4; negative m are the conjugates, except for signs
using Harmonics6 = std::array<std::complex<double>, 7>;

/// Adds Y_4m and Y_6m of a unit vector: associated Legendre functions divided by sin^m, times (x + i y)^m.
void add_harmonics(const V3d& u, Harmonics4& q4, Harmonics6& q6)
{
    const double c = u.z, c2 = c * c, c4 = c2 * c2;
    const double pi = std::numbers::pi;
    static const std::array<double, 5> n4{3.0 / 16 * std::sqrt(1 / pi), 3.0 / 8 * std::sqrt(5 / pi),
                                          3.0 / 8 * std::sqrt(5 / (2 * pi)), 3.0 / 8 * std::sqrt(35 / pi),
                                          3.0 / 16 * std::sqrt(35 / (2 * pi))};
    static const std::array<double, 7> n6{1.0 / 32 * std::sqrt(13 / pi),       1.0 / 16 * std::sqrt(273 / (2 * pi)),
                                          1.0 / 64 * std::sqrt(1365 / pi),     1.0 / 32 * std::sqrt(1365 / pi),
                                          3.0 / 32 * std::sqrt(91 / (2 * pi)), 3.0 / 32 * std::sqrt(1001 / pi),
                                          1.0 / 64 * std::sqrt(3003 / pi)};
    const std::array<double, 5> p4{35 * c4 - 30 * c2 + 3, c * (7 * c2 - 3), 7 * c2 - 1, c, 1};
    const std::array<double, 7> p6{231 * c4 * c2 - 315 * c4 + 105 * c2 - 5,
                                   c * (33 * c4 - 30 * c2 + 5),
                                   33 * c4 - 18 * c2 + 1,
                                   c * (11 * c2 - 3),
                                   11 * c2 - 1,
                                   c,
                                   1};
    std::complex<double> power = 1;
    const std::complex<double> xy(u.x, u.y);
    for (size_t m = 0; m <= 6; ++m, power *= xy) {
        if (m <= 4) q4[m] += n4[m] * p4[m] * power;
        q6[m] += n6[m] * p6[m] * power;
    }
}

/// sum_m a_m conj(b_m) over m = -l..l.
template <size_t N>
double product(const std::array<std::complex<double>, N>& a, const std::array<std::complex<double>, N>& b)
{
    double sum = (a[0] * std::conj(b[0])).real();
    for (size_t m = 1; m < N; ++m) sum += 2 * (a[m] * std::conj(b[m])).real();
    return sum;
}

template <size_t N>
double order(const std::array<std::complex<double>, N>& q, double bonds)
{
    const double l = double(N - 1);
    return bonds > 0 ? std::sqrt(4 * std::numbers::pi / (2 * l + 1) * product(q, q)) / bonds : 0;
}

struct Part {
    uint64_t spheres = 0, bonds = 0;
    Harmonics4 q4{};
    Harmonics6 q6{};
    double local4 = 0, local6 = 0;
    std::vector<uint64_t> counts4 = BondOrder().local_q4, counts6 = counts4;
    std::array<double, 6> fabric{};

    void take(const Harmonics4& own4, const Harmonics6& own6, size_t count)
    {
        ++spheres;
        bonds += count;
        for (size_t m = 0; m < own4.size(); ++m) q4[m] += own4[m];
        for (size_t m = 0; m < own6.size(); ++m) q6[m] += own6[m];
        const double q4_here = order(own4, double(count)), q6_here = order(own6, double(count));
        local4 += q4_here;
        local6 += q6_here;
        ++counts4[std::min(static_cast<size_t>(q4_here / BondOrder::bin_width), counts4.size() - 1)];
        ++counts6[std::min(static_cast<size_t>(q6_here / BondOrder::bin_width), counts6.size() - 1)];
    }
    void add(const Part& o)
    {
        spheres += o.spheres;
        bonds += o.bonds;
        local4 += o.local4;
        local6 += o.local6;
        for (size_t m = 0; m < q4.size(); ++m) q4[m] += o.q4[m];
        for (size_t m = 0; m < q6.size(); ++m) q6[m] += o.q6[m];
        for (size_t k = 0; k < counts4.size(); ++k) {
            counts4[k] += o.counts4[k];
            counts6[k] += o.counts6[k];
        }
        for (size_t k = 0; k < 6; ++k) fabric[k] += o.fabric[k];
    }
};

struct Count {
    uint64_t count = 0;
    void add(const Count& o) { count += o.count; }
};

/// Calls visit(neighbour) for the neighbours of sphere i. A sphere with thousands of neighbours has a wrong radius;
/// only the first neighbours are visited then.
template <class Visit>
void visit_neighbours(const PackedSpheres& spheres, uint64_t i, double stretch, const Visit& visit)
{
    const double r = spheres.radius(i);
    size_t candidates = 0;
    spheres.visit_near(spheres.position(i), r, stretch, [&](const PackedSpheres::Neighbour& n) {
        const double d2 = n.offset.length2(), reach = stretch * (r + n.radius);
        if (d2 > 0 && d2 < reach * reach) visit(n);
        return ++candidates < 4096;
    });
}

} // namespace

BondOrder measure_bond_order(const PackedSpheres& spheres, double number_density, const Progress& progress)
{
    BondOrder result;
    if (!(number_density > 0)) return result;
    // <(r_i + r_j)^3> = 2 <r^3> + 6 <r^2> <r>
    const RadiusMoments& moments = spheres.moments();
    const double stretch =
        reach_in_spacings / std::cbrt(number_density * (2 * moments.m[3] + 6 * moments.m[2] * moments.m[1]));
    // All neighbours must be known, even where the spheres end at a surface.
    const double margin = std::max(0.0, 2 * (stretch - 1) * spheres.largest_radius());
    const std::vector<uint64_t> block = spheres.central_block(most_spheres, margin);
    // Single precision is enough to compare two sums, and halves the memory for a million spheres.
    using Compact = std::array<std::complex<float>, 7>;
    std::vector<Compact> q6(spheres.size());
    std::vector<uint8_t> known(spheres.size());
    const auto compact_of = [](const Harmonics6& q) {
        const double norm = std::sqrt(product(q, q));
        Compact compact{};
        for (size_t m = 0; m < q.size() && norm > 0; ++m) compact[m] = std::complex<float>(q[m] / norm);
        return compact;
    };
    for (const uint64_t i : block) known[i] = 1;
    const Part sum = ordered_sum<Part>(block.size(), 1024, "bond order", progress, [&](uint64_t begin, uint64_t end) {
        Part part;
        for (uint64_t k = begin; k < end; ++k) {
            Harmonics4 own4{};
            Harmonics6 own6{};
            size_t bonds = 0;
            visit_neighbours(spheres, block[k], stretch, [&](const PackedSpheres::Neighbour& n) {
                const V3d u = n.offset.normalized();
                add_harmonics(u, own4, own6);
                ++bonds;
                const double products[6] = {u.x * u.x, u.y * u.y, u.z * u.z, u.x * u.y, u.x * u.z, u.y * u.z};
                for (size_t c = 0; c < 6; ++c) part.fabric[c] += products[c];
            });
            part.take(own4, own6, bonds);
            q6[block[k]] = compact_of(own6);
        }
        return part;
    });
    const Count crystal =
        ordered_sum<Count>(block.size(), 1024, "crystal-like spheres", progress, [&](uint64_t begin, uint64_t end) {
            Count part;
            for (uint64_t k = begin; k < end; ++k) {
                const uint64_t i = block[k];
                size_t bonds = 0, solid = 0;
                visit_neighbours(spheres, i, stretch, [&](const PackedSpheres::Neighbour& n) {
                    Compact other = q6[n.index];
                    if (!known[n.index]) { // beyond the block's edge
                        Harmonics4 unused{};
                        Harmonics6 q{};
                        visit_neighbours(spheres, n.index, stretch, [&](const PackedSpheres::Neighbour& m) {
                            add_harmonics(m.offset.normalized(), unused, q);
                        });
                        other = compact_of(q);
                    }
                    float agreement = (q6[i][0] * std::conj(other[0])).real();
                    for (size_t m = 1; m < other.size(); ++m) agreement += 2 * (q6[i][m] * std::conj(other[m])).real();
                    solid += agreement > static_cast<float>(solid_agreement);
                    ++bonds;
                });
                part.count += solid >= solid_bonds || (solid == bonds && solid >= fewest_bonds);
            }
            return part;
        });
    result.spheres = sum.spheres;
    result.bonds = sum.bonds;
    result.global_q4 = order(sum.q4, double(sum.bonds));
    result.global_q6 = order(sum.q6, double(sum.bonds));
    result.local_q4 = sum.counts4;
    result.local_q6 = sum.counts6;
    result.fabric = fabric_of(sum.fabric, sum.bonds);
    if (sum.spheres == 0) return result;
    const double n = double(sum.spheres);
    result.mean_neighbours = double(sum.bonds) / n;
    result.mean_local_q4 = sum.local4 / n;
    result.mean_local_q6 = sum.local6 / n;
    result.crystal_fraction = double(crystal.count) / n;
    return result;
}

} // namespace scree
