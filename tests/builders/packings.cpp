#include "tests/builders/packings.h"

#include "base/hash.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

using Imath::V3d;

namespace {

/// A periodic cell grid over spheres in [0, edge)^3 with cells of at least the largest diameter.
class Cells {
public:
    Cells(const std::vector<PackedSphere>& spheres, double edge, double reach)
        : spheres_(spheres), edge_(edge), n_(std::max<int64_t>(1, static_cast<int64_t>(edge / reach)))
    {
        first_.assign(static_cast<size_t>(n_ * n_ * n_), -1);
        next_.resize(spheres.size());
        for (size_t i = 0; i < spheres.size(); ++i) {
            int64_t& head = first_[cell_of(spheres[i].center)];
            next_[i] = head;
            head = static_cast<int64_t>(i);
        }
    }

    /// Calls f(j, vector from i to the nearest image of j) for each j < i in the neighbouring cells.
    template <class F>
    void for_earlier(size_t i, const F& f) const
    {
        const V3d p = spheres_[i].center;
        const int64_t reach = n_ >= 3 ? 1 : 0;
        for (int64_t dz = -reach; dz <= reach; ++dz) {
            for (int64_t dy = -reach; dy <= reach; ++dy) {
                for (int64_t dx = -reach; dx <= reach; ++dx) visit(i, p, dx, dy, dz, f);
            }
        }
    }

private:
    template <class F>
    void visit(size_t i, const V3d& p, int64_t dx, int64_t dy, int64_t dz, const F& f) const
    {
        const auto index = [&](double x, int64_t d) { return (coordinate(x) + d + n_) % n_; };
        const size_t cell = static_cast<size_t>((index(p.z, dz) * n_ + index(p.y, dy)) * n_ + index(p.x, dx));
        const size_t begin = n_ >= 3 ? cell : 0, end = n_ >= 3 ? cell + 1 : first_.size();
        for (size_t c = begin; c < end; ++c) {
            for (int64_t j = first_[c]; j >= 0; j = next_[static_cast<size_t>(j)]) {
                if (static_cast<size_t>(j) >= i) continue;
                V3d v = spheres_[static_cast<size_t>(j)].center - p;
                for (int a = 0; a < 3; ++a) v[a] -= edge_ * std::round(v[a] / edge_);
                f(static_cast<size_t>(j), v);
            }
        }
    }
    int64_t coordinate(double x) const
    {
        return std::clamp<int64_t>(static_cast<int64_t>(x / edge_ * static_cast<double>(n_)), 0, n_ - 1);
    }
    size_t cell_of(const V3d& p) const
    {
        return static_cast<size_t>((coordinate(p.z) * n_ + coordinate(p.y)) * n_ + coordinate(p.x));
    }

    const std::vector<PackedSphere>& spheres_;
    double edge_;
    int64_t n_;
    std::vector<int64_t> first_, next_;
};

void shift(std::vector<PackedSphere>& spheres, double by)
{
    for (PackedSphere& s : spheres) s.center += V3d(by);
}

} // namespace

double packing_edge(const std::vector<PackedSphere>& spheres, double fraction)
{
    double volume = 0;
    for (const PackedSphere& s : spheres) volume += 4.0 / 3 * std::numbers::pi * s.radius * s.radius * s.radius;
    return std::cbrt(volume / fraction);
}

std::vector<PackedSphere> push_apart(uint64_t count, double fraction, double smallest, double overlap, uint64_t seed)
{
    std::vector<PackedSphere> spheres(count);
    for (uint64_t i = 0; i < count; ++i)
        spheres[i].radius = smallest + (1 - smallest) * unit_double(hash_index(i, seed, 0));
    const double edge = packing_edge(spheres, fraction);
    for (uint64_t i = 0; i < count; ++i) {
        for (int a = 0; a < 3; ++a)
            spheres[i].center[a] = edge * unit_double(hash_index(i, seed, static_cast<uint64_t>(a) + 1));
    }
    std::vector<V3d> push(count);
    for (int round = 0; round < 1000; ++round) {
        std::fill(push.begin(), push.end(), V3d(0));
        const Cells cells(spheres, edge, 2.0);
        double worst = 0;
        for (size_t i = 0; i < count; ++i) {
            cells.for_earlier(i, [&](size_t j, const V3d& v) {
                const double sum = spheres[i].radius + spheres[j].radius, d2 = v.length2();
                if (d2 >= sum * sum) return;
                const double d = std::sqrt(d2), gap = sum - d;
                worst = std::max(worst, gap / std::min(spheres[i].radius, spheres[j].radius));
                const V3d along = d > 0 ? v / d : V3d(1, 0, 0);
                push[i] -= 0.5 * gap * along;
                push[j] += 0.5 * gap * along;
            });
        }
        if (worst <= overlap) break;
        for (size_t i = 0; i < count; ++i) {
            spheres[i].center += push[i];
            for (int a = 0; a < 3; ++a) spheres[i].center[a] -= edge * std::floor(spheres[i].center[a] / edge);
        }
    }
    shift(spheres, -0.5 * edge);
    return spheres;
}

std::vector<PackedSphere> repeat_packing(const std::vector<PackedSphere>& tile, double edge, int cells, uint64_t count)
{
    std::vector<PackedSphere> spheres;
    spheres.reserve(count);
    for (int z = 0; z < cells; ++z) {
        for (int y = 0; y < cells; ++y) {
            for (int x = 0; x < cells; ++x) {
                const V3d offset = edge * (V3d(x, y, z) - V3d(0.5 * (cells - 1)));
                for (const PackedSphere& s : tile) {
                    if (spheres.size() == count) return spheres;
                    spheres.push_back({s.center + offset, s.radius});
                }
            }
        }
    }
    return spheres;
}

double largest_overlap(const std::vector<PackedSphere>& spheres, double edge)
{
    std::vector<PackedSphere> moved = spheres;
    shift(moved, 0.5 * edge);
    const Cells cells(moved, edge, 2.0);
    double worst = 0;
    for (size_t i = 0; i < moved.size(); ++i) {
        cells.for_earlier(i, [&](size_t j, const V3d& v) {
            const double gap = moved[i].radius + moved[j].radius - v.length();
            worst = std::max(worst, gap / std::min(moved[i].radius, moved[j].radius));
        });
    }
    return worst;
}

} // namespace scree
