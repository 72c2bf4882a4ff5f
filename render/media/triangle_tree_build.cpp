#include "base/error.h"
#include "render/media/triangle_tree.h"

#include <fmt/format.h>
#include <tbb/concurrent_vector.h>
#include <tbb/parallel_for.h>

#include <limits>
#include <numeric>

namespace scree {

namespace {

struct Bounds {
    V3f lo{std::numeric_limits<float>::infinity()}, hi{-std::numeric_limits<float>::infinity()};

    void extend(const V3f& p)
    {
        for (int k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], p[k]);
            hi[k] = std::max(hi[k], p[k]);
        }
    }
    void extend(const Bounds& b)
    {
        extend(b.lo);
        extend(b.hi);
    }
    double area() const
    {
        if (!(lo.x <= hi.x)) return 0;
        const V3d d = V3d(hi) - V3d(lo);
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }
    V3f middle() const { return lo * 0.5f + hi * 0.5f; }
};

struct Range {
    size_t first, last;
    Bounds bounds;

    size_t count() const { return last - first; }
};

constexpr size_t bins = 16, worth_a_task = 4096, halving_depth = 24, worth_turning = 64;

} // namespace

class TriangleTreeBuilder {
public:
    TriangleTreeBuilder(std::span<const TriangleView> meshes, double scale, const Progress& progress)
        : progress_(progress)
    {
        size_t count = 0;
        for (const TriangleView& mesh : meshes) count += mesh.triangles.size();
        corners_.resize(count);
        bounds_.resize(count);
        order_.resize(count);
        std::iota(order_.begin(), order_.end(), size_t{0});
        size_t first = 0;
        for (const TriangleView& mesh : meshes) {
            tbb::parallel_for(size_t{0}, mesh.triangles.size(), [&](size_t t) { take(mesh, t, first + t, scale); });
            first += mesh.triangles.size();
            if (progress.cancelled()) throw Cancelled();
        }
    }

    void build(TriangleTree& tree)
    {
        if (order_.empty()) return;
        Range all{0, order_.size(), {}};
        for (const Bounds& b : bounds_) all.bounds.extend(b);
        nodes_.grow_by(1);
        fill(0, all, 0);
        if (progress_.cancelled()) throw Cancelled();
        tree.nodes_.assign(nodes_.begin(), nodes_.end());
        tree.blocks_.assign(blocks_.begin(), blocks_.end());
    }

private:
    void take(const TriangleView& mesh, size_t t, size_t to, double scale)
    {
        if (progress_.cancelled()) return;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t vertex = mesh.triangles[t][k];
            if (vertex >= mesh.positions.size())
                throw InputError("clearance field", fmt::format("vertex {}", vertex),
                                 fmt::format("below {}", mesh.positions.size()));
            const V3d p(mesh.positions[vertex]);
            if (!std::isfinite(p.x + p.y + p.z))
                throw InputError("clearance field", fmt::format("vertex {} that is not finite", vertex),
                                 "finite numbers");
            const V3d scaled = p * scale;
            if (!(std::max({std::abs(scaled.x), std::abs(scaled.y), std::abs(scaled.z)}) < 0x1p100))
                throw InputError("clearance field", fmt::format("vertex {} that is 2^100 boxes away", vertex),
                                 "vertices near the box");
            corners_[to][k] = V3f(scaled);
            bounds_[to].extend(corners_[to][k]);
        }
    }

    /// Makes the children of node `at` from a range that is not empty.
    void fill(size_t at, const Range& range, size_t depth)
    {
        std::vector<Range> parts{range};
        while (parts.size() < TriangleTree::width) {
            // The part with the largest surface, which is the most expensive to visit.
            size_t most = parts.size();
            double cost = -1;
            for (size_t k = 0; k < parts.size(); ++k) {
                if (parts[k].count() <= TriangleBlock::lanes) continue;
                const double c = parts[k].bounds.area();
                if (c > cost) {
                    cost = c;
                    most = k;
                }
            }
            if (most == parts.size()) break;
            const auto [low, high] = split(parts[most], depth);
            parts[most] = low;
            parts.push_back(high);
        }
        TriangleTree::Node node;
        for (auto& half : node.half) half.fill(-0x1p60f);
        for (size_t k = 0; k < parts.size(); ++k) {
            set_box(node, k, parts[k]);
            const bool block = parts[k].count() <= TriangleBlock::lanes;
            node.child[k] = block ? TriangleTree::leaf | make_block(parts[k])
                                  : static_cast<uint32_t>(nodes_.grow_by(1) - nodes_.begin());
        }
        nodes_[at] = node;
        if (progress_.cancelled()) return;
        const auto descend = [&](size_t k) {
            if (!(node.child[k] & TriangleTree::leaf)) fill(node.child[k], parts[k], depth + 1);
        };
        if (range.count() > worth_a_task)
            tbb::parallel_for(size_t{0}, parts.size(), descend);
        else
            for (size_t k = 0; k < parts.size(); ++k) descend(k);
    }

    /// Orients the box along the mean normal and the farthest corner in the plane across it; along the coordinate axes
    /// if the oriented box is not smaller.
    void set_box(TriangleTree::Node& node, size_t k, const Range& range) const
    {
        V3d normal(0);
        for (size_t i = range.first; i < range.last; ++i) {
            const auto& c = corners_[order_[i]];
            normal += (V3d(c[1]) - V3d(c[0])).cross(V3d(c[2]) - V3d(c[0]));
        }
        std::array<V3f, 3> axes{V3f(1, 0, 0), V3f(0, 1, 0), V3f(0, 0, 1)};
        V3d lo = V3d(range.bounds.lo), hi = V3d(range.bounds.hi);
        if (const double length = normal.length(); length > 0 && std::isfinite(length)) {
            normal /= length;
            const V3d middle = lo * 0.5 + hi * 0.5;
            V3d along(0);
            for (size_t i = range.first; i < range.last; ++i)
                for (const V3f& corner : corners_[order_[i]]) {
                    const V3d from = V3d(corner) - middle, flat = from - normal * normal.dot(from);
                    if (flat.length2() > along.length2()) along = flat;
                }
            if (along.length() > 0) {
                // Orthogonalises a second time: the first may leave a large part along the normal.
                along = (along - normal * normal.dot(along)).normalized();
                const V3d across = normal.cross(along).normalized();
                // Small boxes are many and so worth a search over angles: a box along the diagonal of a patch is twice
                // as large as needed.
                const int angles = range.count() <= worth_turning ? 6 : 1;
                for (int angle = 0; angle < angles; ++angle) {
                    const double c = std::cos(pi / 2 * angle / angles), s = std::sin(pi / 2 * angle / angles);
                    const std::array<V3f, 3> turned{V3f(normal), V3f(along * c + across * s),
                                                    V3f(across * c - along * s)};
                    V3d low, high;
                    measure(turned, range, low, high);
                    const auto area = [](const V3d& d) { return d.x * d.y + d.y * d.z + d.z * d.x; };
                    if (area(high - low) >= area(hi - lo)) continue;
                    axes = turned;
                    lo = low;
                    hi = high;
                }
            }
        }
        const V3d m = (lo + hi) * 0.5;
        const V3f middle{V3d(axes[0]) * m.x + V3d(axes[1]) * m.y + V3d(axes[2]) * m.z};
        measure(axes, range, lo, hi);
        for (size_t axis = 0; axis < 3; ++axis) {
            const int a = static_cast<int>(axis);
            const double at = V3d(axes[axis]).dot(V3d(middle));
            const auto half =
                static_cast<float>(std::max(hi[a] - at, at - lo[a]) * (1 + 0x1p-22) +
                                   0x1p-49 * (std::abs(middle.x) + std::abs(middle.y) + std::abs(middle.z)));
            node.middle[axis][k] = middle[a];
            node.half[axis][k] = half;
            for (size_t j = 0; j < 3; ++j) node.axes[axis][j][k] = axes[axis][static_cast<int>(j)];
        }
    }

    /// The extent of the range's corners along axes.
    void measure(const std::array<V3f, 3>& axes, const Range& range, V3d& lo, V3d& hi) const
    {
        const std::array<V3d, 3> wide{V3d(axes[0]), V3d(axes[1]), V3d(axes[2])};
        lo = V3d(std::numeric_limits<double>::infinity());
        hi = -lo;
        for (size_t i = range.first; i < range.last; ++i)
            for (const V3f& corner : corners_[order_[i]]) {
                const V3d c(corner);
                for (int a = 0; a < 3; ++a) {
                    const double at = wide[static_cast<size_t>(a)].dot(c);
                    lo[a] = std::min(lo[a], at);
                    hi[a] = std::max(hi[a], at);
                }
            }
    }

    uint32_t make_block(const Range& range)
    {
        TriangleBlock block;
        for (size_t lane = 0; lane < TriangleBlock::lanes; ++lane)
            block.set(lane, corners_[order_[range.first + std::min(lane, range.count() - 1)]]);
        return static_cast<uint32_t>(blocks_.push_back(block) - blocks_.begin());
    }

    /// Splits by the binned surface area heuristic along the axis in which the middles spread most. Splits into halves
    /// if that separates nothing, or below depth `halving_depth`.
    std::pair<Range, Range> split(const Range& range, size_t depth)
    {
        Bounds middles;
        for (size_t i = range.first; i < range.last; ++i) middles.extend(bounds_[order_[i]].middle());
        const V3d spread = V3d(middles.hi) - V3d(middles.lo);
        const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
        const auto begin = order_.begin() + static_cast<ptrdiff_t>(range.first),
                   end = order_.begin() + static_cast<ptrdiff_t>(range.last);
        auto cut = begin;
        if (spread[axis] > 0 && depth < halving_depth) {
            const double low = double{middles.lo[axis]}, per_bin = bins / spread[axis];
            const auto bin_of = [&](size_t t) {
                return std::min(bins - 1, static_cast<size_t>((double{bounds_[t].middle()[axis]} - low) * per_bin));
            };
            std::array<Bounds, bins> bin;
            std::array<size_t, bins> count{};
            for (auto i = begin; i != end; ++i) {
                const size_t b = bin_of(*i);
                bin[b].extend(bounds_[*i]);
                ++count[b];
            }
            const auto cost = [](const Bounds& b, size_t n) {
                return b.area() * static_cast<double>((n + TriangleBlock::lanes - 1) / TriangleBlock::lanes);
            };
            std::array<double, bins> above{}; // cost of the bins from here on
            Bounds sum;
            size_t n = 0;
            for (size_t b = bins; b-- > 1;) {
                sum.extend(bin[b]);
                above[b] = cost(sum, n += count[b]);
            }
            sum = {};
            n = 0;
            size_t best = 0;
            double least = std::numeric_limits<double>::infinity();
            for (size_t b = 1; b < bins; ++b) {
                sum.extend(bin[b - 1]);
                n += count[b - 1];
                const double c = cost(sum, n) + above[b];
                if (n == 0 || n == range.count() || !(c < least)) continue;
                least = c;
                best = b;
            }
            if (best > 0) cut = std::partition(begin, end, [&](size_t t) { return bin_of(t) < best; });
        }
        if (cut == begin || cut == end) {
            cut = begin + (end - begin) / 2;
            std::nth_element(begin, cut, end, [&](size_t a, size_t b) {
                const float ma = bounds_[a].middle()[axis], mb = bounds_[b].middle()[axis];
                return ma < mb || (ma == mb && a < b);
            });
        }
        Range low{range.first, range.first + static_cast<size_t>(cut - begin), {}}, high{low.last, range.last, {}};
        for (size_t i = low.first; i < low.last; ++i) low.bounds.extend(bounds_[order_[i]]);
        for (size_t i = high.first; i < high.last; ++i) high.bounds.extend(bounds_[order_[i]]);
        return {low, high};
    }

    const Progress& progress_;
    std::vector<std::array<V3f, 3>> corners_; // scaled
    std::vector<Bounds> bounds_;
    std::vector<size_t> order_;
    tbb::concurrent_vector<TriangleTree::Node> nodes_;
    tbb::concurrent_vector<TriangleBlock> blocks_;
};

TriangleTree::TriangleTree(std::span<const TriangleView> meshes, double scale, const Progress& progress)
{
    TriangleTreeBuilder(meshes, scale, progress).build(*this);
}

} // namespace scree
