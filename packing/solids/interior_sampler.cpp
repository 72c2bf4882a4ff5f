#include "packing/solids/interior_sampler.h"

#include "base/hash.h"
#include "packing/solids/surface_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace scree {

namespace {

using Imath::V3d;

/// Streams of the hash, one for each number drawn for a point; rejection continues with further streams.
enum Stream : uint64_t { cell_stream = 0x7e700, keep_stream, first_place_stream };

/// Draws from weights in constant time (Walker 1977, set up as in Vose 1991).
class AliasTable {
public:
    explicit AliasTable(const std::vector<double>& weights) : keep_(weights.size(), 1), other_(weights.size(), 0)
    {
        const auto n = static_cast<double>(weights.size());
        double sum = 0;
        for (const double w : weights) sum += w;
        std::vector<uint32_t> small, large;
        for (uint32_t k = 0; k < weights.size(); ++k) {
            keep_[k] = weights[k] * (n / sum);
            (keep_[k] < 1 ? small : large).push_back(k);
        }
        while (!small.empty() && !large.empty()) {
            const uint32_t s = small.back(), l = large.back();
            small.pop_back();
            other_[s] = l;
            keep_[l] -= 1 - keep_[s];
            if (keep_[l] >= 1) continue;
            large.pop_back();
            small.push_back(l);
        }
        // The remaining entries are 1 except for rounding.
        for (const auto* rest : {&small, &large})
            for (const uint32_t k : *rest) keep_[k] = 1;
    }

    size_t draw(double u, double v) const
    {
        const size_t k = std::min(static_cast<size_t>(u * static_cast<double>(keep_.size())), keep_.size() - 1);
        return v < keep_[k] ? k : other_[k];
    }

private:
    std::vector<double> keep_;
    std::vector<uint32_t> other_;
};

/// Six times the volume, from differences, so that the distance from the origin does not matter.
double six_volumes(const V3d& a, const V3d& b, const V3d& c, const V3d& d)
{
    return std::abs((b - a).dot((c - a).cross(d - a)));
}

/// Cubes that together contain the domain, for rejection sampling.
struct Cubes {
    std::vector<V3d> corner;
    double edge = 0;
};

Cubes cubes_around(const Domain& domain)
{
    constexpr int along_longest = 48;
    const auto& [lo, hi] = domain.bounds();
    const V3d size = hi - lo;
    Cubes cubes;
    cubes.edge = std::max({size.x, size.y, size.z}) / along_longest;
    const double reach = cubes.edge * std::sqrt(0.75) * (1 + 1e-9);
    int count[3];
    for (int k = 0; k < 3; ++k) count[k] = std::max(1, static_cast<int>(std::ceil(size[k] / cubes.edge)));
    for (int x = 0; x < count[0]; ++x)
        for (int y = 0; y < count[1]; ++y)
            for (int z = 0; z < count[2]; ++z) {
                const V3d corner = lo + V3d(x, y, z) * cubes.edge, middle = corner + V3d(cubes.edge / 2);
                if (domain.surface().rough_distance(middle, 0.1).lo <= reach || domain.contains(middle))
                    cubes.corner.push_back(corner);
            }
    return cubes;
}

} // namespace

struct InteriorSampler::Impl {
    const Domain& domain;
    double volume = 0;
    std::string method;
    Tetrahedra solid; ///< the cells inside the domain; empty: rejection sampling is used
    std::optional<AliasTable> cells;
    Cubes cubes;

    explicit Impl(const Domain& d) : domain(d) {}

    bool take_tetrahedra(Tetrahedra all, std::string& trouble);
    V3d place_in_cell(uint64_t index, uint64_t seed) const;
    V3d place_by_rejection(uint64_t index, uint64_t seed) const;
};

/// Keeps the cells inside the domain; returns false, with the reason in `trouble`, if they do not fill it.
bool InteriorSampler::Impl::take_tetrahedra(Tetrahedra all, std::string& trouble)
{
    // Scaled by a power of two, so that cubes of lengths neither overflow nor underflow.
    const V3d half = domain.bounds().max * 0.5 - domain.bounds().min * 0.5;
    const int exponent = std::ilogb(std::max({half.x, half.y, half.z}));
    const double scale = std::scalbn(1.0, -exponent);
    const auto corner = [&](size_t cell, size_t c) -> const V3d& { return all.points[all.cells[cell][c]]; };
    std::vector<double> volumes;
    std::map<int32_t, size_t> largest; // cell of each region: the safest one to test which side the region is on
    for (size_t k = 0; k < all.cells.size(); ++k) {
        const V3d &a = corner(k, 0), &b = corner(k, 1), &c = corner(k, 2), &d = corner(k, 3);
        volumes.push_back(six_volumes(V3d(0), (b - a) * scale, (c - a) * scale, (d - a) * scale) / 6);
        const auto [at, fresh] = largest.try_emplace(all.region[k], k);
        if (!fresh && volumes[k] > volumes[at->second]) at->second = k;
    }
    std::map<int32_t, bool> inside;
    for (const auto& [region, k] : largest) {
        const V3d middle = (corner(k, 0) * 0.25 + corner(k, 1) * 0.25) + (corner(k, 2) * 0.25 + corner(k, 3) * 0.25);
        inside[region] = domain.contains(middle);
    }
    std::vector<double> kept;
    double sum = 0;
    for (size_t k = 0; k < all.cells.size(); ++k) {
        if (!inside[all.region[k]]) continue;
        solid.cells.push_back(all.cells[k]);
        kept.push_back(volumes[k]);
        sum += volumes[k];
    }
    // The faces are kept whole, so both volumes are equal except for rounding.
    const double truth = std::scalbn(domain.volume(), -3 * exponent);
    if (std::isfinite(truth) && truth > 0 && !(std::abs(sum - truth) <= 1e-9 * truth)) {
        trouble = fmt::format("its tetrahedra fill {} times the enclosed volume", sum / truth);
        solid.cells.clear();
        return false;
    }
    solid.points = std::move(all.points);
    volume = std::scalbn(sum, 3 * exponent);
    cells.emplace(kept);
    return true;
}

V3d InteriorSampler::Impl::place_in_cell(uint64_t index, uint64_t seed) const
{
    const auto number = [&](uint64_t stream) { return unit_double(hash_index(index, seed, stream)); };
    const auto& [i, j, k, l] = solid.cells[cells->draw(number(cell_stream), number(keep_stream))];
    // The gaps between sorted numbers are barycentric coordinates uniform in the tetrahedron (Devroye 1986, V.2.1).
    double u[3] = {number(first_place_stream), number(first_place_stream + 1), number(first_place_stream + 2)};
    std::ranges::sort(u);
    const V3d& a = solid.points[i];
    return a + (solid.points[j] - a) * u[0] + (solid.points[k] - a) * (u[1] - u[0]) +
           (solid.points[l] - a) * (u[2] - u[1]);
}

V3d InteriorSampler::Impl::place_by_rejection(uint64_t index, uint64_t seed) const
{
    for (uint64_t stream = first_place_stream;; stream += 4) {
        const auto number = [&](uint64_t k) { return unit_double(hash_index(index, seed, stream + k)); };
        const auto cube = static_cast<size_t>(number(0) * static_cast<double>(cubes.corner.size()));
        const V3d place =
            cubes.corner[std::min(cube, cubes.corner.size() - 1)] + V3d(number(1), number(2), number(3)) * cubes.edge;
        if (domain.contains(place)) return place;
    }
}

InteriorSampler::InteriorSampler(const Domain& domain, const TetgenOptions& options)
    : impl_(std::make_unique<Impl>(domain))
{
    std::string trouble;
    Tetrahedra all = tetrahedralize(domain.mesh(), options, trouble);
    if (trouble.empty() && impl_->take_tetrahedra(std::move(all), trouble)) {
        impl_->method = fmt::format("TetGen, {} tetrahedra", impl_->solid.cells.size());
        return;
    }
    impl_->volume = domain.volume();
    impl_->cubes = cubes_around(domain);
    impl_->method = fmt::format("divergence theorem and rejection, without TetGen: {}", trouble);
}

InteriorSampler::~InteriorSampler() = default;

double InteriorSampler::volume() const { return impl_->volume; }

V3d InteriorSampler::sample(uint64_t index, uint64_t seed) const
{
    return by_tetgen() ? impl_->place_in_cell(index, seed) : impl_->place_by_rejection(index, seed);
}

const std::string& InteriorSampler::method() const { return impl_->method; }

bool InteriorSampler::by_tetgen() const { return impl_->cells.has_value(); }

} // namespace scree
