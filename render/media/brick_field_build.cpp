#include "render/media/brick_field_build.h"

#include "base/error.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <optional>

namespace scree {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using Values = std::array<float, 3>;

Values values_of(float v) { return {v, v, v}; }
Values values_of(double v) { return values_of(static_cast<float>(v)); }
template <class T>
Values values_of(const openvdb::math::Vec3<T>& v)
{
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

constexpr int32_t width = BrickField::width;
constexpr uint64_t most_root_entries = 1 << 15;

/// A leaf of the tree, or a tile that is not background.
struct Item {
    CoordBBox box;
    bool is_tile;
    Values value; // of a tile only
};
using Items = std::vector<uint32_t>;

/// Bricks lo..hi along each axis, both included.
struct BrickRange {
    std::array<int32_t, 3> lo, hi;
};

/// A brick whose values are still to be filled in.
struct Brick {
    std::array<int32_t, 3> low; // in bricks
    size_t content;
};

template <class GridType>
class Builder {
public:
    Builder(const GridType& grid, const FieldLimits& limits, bool nearest, std::string place, const Progress& progress)
        : grid_(grid), limits_(limits), place_(std::move(place)), progress_(progress), reach_(nearest ? 0 : 1)
    {
        field_.planes = openvdb::VecTraits<typename GridType::ValueType>::IsVec ? 3 : 1;
        field_.nearest = nearest;
        field_.background = values_of(grid.background());
    }

    /// origin: set to the voxel at field coordinates 0.
    BrickField build(Coord& origin)
    {
        collect_items();
        if (items_.empty()) return field_;
        lay_out_root();
        fill_root();
        fill_bricks();
        drop_empty();
        origin = Coord(origin_[0] * width, origin_[1] * width, origin_[2] * width);
        if (field_.contents.empty()) field_.bricks = {0, 0, 0};
        return std::move(field_);
    }

private:
    using TreeType = typename GridType::TreeType;
    using Accessor = openvdb::tree::ValueAccessor<const TreeType, false>;

    void check(const Values& v, const Coord& where) const
    {
        for (int plane = 0; plane < field_.planes; ++plane) {
            const double x = v[static_cast<size_t>(plane)];
            const bool good =
                limits_.open ? x > limits_.low && x < limits_.high : x >= limits_.low && x <= limits_.high;
            if (!good || !std::isfinite(x))
                throw InputError(
                    place_,
                    fmt::format("{} of {} at voxel ({}, {}, {})", limits_.name, x, where.x(), where.y(), where.z()),
                    limits_.expected);
        }
    }

    void collect_items()
    {
        const TreeType& tree = grid_.tree();
        for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
            for (auto value = leaf->cbeginValueAll(); value; ++value) check(values_of(*value), value.getCoord());
            items_.push_back({leaf->getNodeBoundingBox(), false, {}});
            if (progress_.cancelled()) throw Cancelled();
        }
        auto tile = tree.cbeginValueAll();
        tile.setMaxDepth(TreeType::ValueAllCIter::LEAF_DEPTH - 1);
        for (; tile; ++tile) {
            const Values v = values_of(*tile);
            if (v == field_.background) continue;
            check(v, tile.getCoord());
            items_.push_back({tile.getBoundingBox(), true, v});
        }
    }

    /// The bricks that have a corner whose value depends on the item.
    BrickRange range_of(const Item& item) const
    {
        const int32_t beside = limits_.mean_beside ? 1 : 0;
        BrickRange range;
        for (size_t k = 0; k < 3; ++k) {
            range.lo[k] = (item.box.min()[static_cast<int>(k)] - reach_ - beside) >> 3;
            range.hi[k] = (item.box.max()[static_cast<int>(k)] + beside) >> 3;
        }
        return range;
    }

    void lay_out_root()
    {
        BrickRange all = range_of(items_[0]);
        for (const Item& item : items_) {
            const BrickRange range = range_of(item);
            for (size_t k = 0; k < 3; ++k) {
                all.lo[k] = std::min(all.lo[k], range.lo[k]);
                all.hi[k] = std::max(all.hi[k], range.hi[k]);
            }
        }
        for (int& levels = field_.levels;; ++levels) {
            uint64_t entries = 1;
            for (size_t k = 0; k < 3; ++k) {
                const int shift = 3 * levels;
                origin_[k] = all.lo[k] >> shift << shift;
                field_.root_size[k] = static_cast<size_t>((all.hi[k] >> shift) - (all.lo[k] >> shift) + 1);
                entries *= field_.root_size[k];
            }
            if (entries <= most_root_entries) break;
        }
        for (size_t k = 0; k < 3; ++k) {
            const uint64_t bricks = field_.root_size[k] << (3 * field_.levels);
            constexpr int32_t farthest = 1 << 26;
            if (bricks > farthest || all.lo[k] < -farthest || all.hi[k] > farthest)
                throw InputError(place_,
                                 fmt::format("a grid of {} from voxel {} to {}", limits_.name,
                                             int64_t{all.lo[k]} * width, int64_t{all.hi[k]} * width),
                                 "voxels within 2^29 of 0");
            field_.bricks[k] = static_cast<int32_t>(bricks);
        }
    }

    /// Distributes the items to the children of a region: n children along each axis, each 8^level bricks wide.
    std::vector<Items> deal(const Items& items, const std::array<int32_t, 3>& low, int level,
                            const std::array<size_t, 3>& n) const
    {
        std::vector<Items> children(n[0] * n[1] * n[2]);
        for (const uint32_t index : items) {
            const BrickRange range = range_of(items_[index]);
            std::array<size_t, 3> from, to;
            for (size_t k = 0; k < 3; ++k) {
                const int shift = 3 * level;
                from[k] = static_cast<size_t>(std::max(0, (range.lo[k] >> shift) - (low[k] >> shift)));
                to[k] =
                    std::min(n[k], static_cast<size_t>(std::max(0, (range.hi[k] >> shift) - (low[k] >> shift) + 1)));
            }
            for (size_t i = from[0]; i < to[0]; ++i)
                for (size_t j = from[1]; j < to[1]; ++j)
                    for (size_t k = from[2]; k < to[2]; ++k) children[(i * n[1] + j) * n[2] + k].push_back(index);
        }
        return children;
    }

    void fill_root()
    {
        Items all(items_.size());
        for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<uint32_t>(i);
        const std::array<size_t, 3>& n = field_.root_size;
        const std::vector<Items> children = deal(all, origin_, field_.levels, n);
        field_.root.assign(children.size(), BrickField::entry_empty);
        const int32_t size = 1 << (3 * field_.levels);
        for (size_t c = 0; c < children.size(); ++c)
            field_.root[c] = entry(children[c], field_.levels,
                                   {origin_[0] + static_cast<int32_t>(c / n[2] / n[1]) * size,
                                    origin_[1] + static_cast<int32_t>(c / n[2] % n[1]) * size,
                                    origin_[2] + static_cast<int32_t>(c % n[2]) * size});
    }

    uint32_t add_content(const std::array<int32_t, 3>& low)
    {
        bricks_.push_back({low, field_.contents.size()});
        field_.contents.emplace_back();
        return static_cast<uint32_t>(field_.contents.size() - 1) << 2 | BrickField::entry_content;
    }

    /// Whether all corners of the region's cells lie in tiles of one value.
    bool is_constant(const Items& items, const std::array<int32_t, 3>& low, int32_t size) const
    {
        CoordBBox region(
            Coord(low[0] * width, low[1] * width, low[2] * width),
            Coord((low[0] + size) * width, (low[1] + size) * width, (low[2] + size) * width).offsetBy(reach_ - 1));
        uint64_t covered = 0;
        for (const uint32_t index : items) {
            const Item& item = items_[index];
            if (!item.is_tile || item.value != items_[items[0]].value) return false;
            CoordBBox common = region;
            common.intersect(item.box);
            covered += common.empty() ? 0 : common.volume();
        }
        return covered == region.volume();
    }

    uint32_t add_constant(const Values& value, const std::array<int32_t, 3>& low, int32_t size)
    {
        const V3d place((low[0] - origin_[0]) * width, (low[1] - origin_[1]) * width, (low[2] - origin_[2]) * width);
        field_.support.extendBy(Imath::Box3d(place, place + V3d(double{width} * size)));
        field_.contents.push_back({0, true, value, value});
        return static_cast<uint32_t>(field_.contents.size() - 1) << 2 | BrickField::entry_content;
    }

    /// Makes the entry of a region that begins at brick `low` and is 8^level bricks wide. In `nodes`, children come
    /// before their parents.
    uint32_t entry(const Items& items, int level, const std::array<int32_t, 3>& low)
    {
        if (items.empty()) return BrickField::entry_empty;
        const int32_t size = 1 << (3 * level);
        if (is_constant(items, low, size)) return add_constant(items_[items[0]].value, low, size);
        if (level == 0) return add_content(low);
        if (progress_.cancelled()) throw Cancelled();
        const std::vector<Items> children = deal(items, low, level - 1, {8, 8, 8});
        std::array<uint32_t, 512> node{};
        const int32_t child = size / 8;
        for (size_t c = 0; c < 512; ++c)
            node[c] =
                entry(children[c], level - 1,
                      {low[0] + static_cast<int32_t>(c >> 6) * child, low[1] + static_cast<int32_t>(c >> 3 & 7) * child,
                       low[2] + static_cast<int32_t>(c & 7) * child});
        field_.nodes.push_back(node);
        return static_cast<uint32_t>(field_.nodes.size() - 1) << 2 | BrickField::entry_node;
    }

    Values corner(const Accessor& accessor, const Coord& where) const
    {
        typename GridType::ValueType value;
        if (accessor.probeValue(where, value) || !limits_.mean_beside) return values_of(value);
        std::array<double, 3> sum{};
        int active = 0;
        for (int n = 0; n < 27; ++n) {
            typename GridType::ValueType beside;
            if (!accessor.probeValue(where.offsetBy(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1), beside)) continue;
            const Values v = values_of(beside);
            for (size_t k = 0; k < 3; ++k) sum[k] += double{v[k]};
            ++active;
        }
        if (active == 0) return values_of(value);
        return {static_cast<float>(sum[0] / active), static_cast<float>(sum[1] / active),
                static_cast<float>(sum[2] / active)};
    }

    void fill_bricks()
    {
        const size_t planes = static_cast<size_t>(field_.planes), size = planes * BrickField::corners;
        std::vector<float> values(bricks_.size() * size);
        std::vector<Imath::Box3d> supports(bricks_.size());
        std::atomic<uint64_t> done{0};
        tbb::parallel_for(size_t{0}, bricks_.size(), [&](size_t i) {
            if (progress_.cancelled()) return;
            fill_brick(bricks_[i], values.data() + i * size, supports[i]);
            const uint64_t n = ++done;
            if (n % 4096 == 0)
                progress_.update("grid of " + limits_.name,
                                 static_cast<double>(n) / static_cast<double>(bricks_.size()));
        });
        if (progress_.cancelled()) throw Cancelled();
        // Constant bricks keep one value, so the values of the others move to the front.
        size_t used = 0;
        for (size_t i = 0; i < bricks_.size(); ++i) {
            BrickField::Content& content = field_.contents[bricks_[i].content];
            field_.support.extendBy(supports[i]);
            if (content.constant) continue;
            content.offset = used;
            std::copy_n(values.data() + i * size, size, values.data() + used);
            used += size;
        }
        values.resize(used);
        for (BrickField::Content& content : field_.contents) {
            if (!content.constant) continue;
            content.offset = values.size();
            values.insert(values.end(), content.low.begin(), content.low.begin() + static_cast<int64_t>(planes));
        }
        values.shrink_to_fit();
        field_.values = std::move(values);
    }

    void fill_brick(const Brick& brick_and_content, float* values, Imath::Box3d& support)
    {
        const Accessor accessor(grid_.tree());
        const std::array<int32_t, 3>& brick = brick_and_content.low;
        BrickField::Content& content = field_.contents[brick_and_content.content];
        const Coord low(brick[0] * width, brick[1] * width, brick[2] * width);
        content.low.fill(std::numeric_limits<float>::max());
        content.high.fill(std::numeric_limits<float>::lowest());
        Imath::Box3d used;
        for (int32_t x = 0; x < BrickField::stride; ++x)
            for (int32_t y = 0; y < BrickField::stride; ++y)
                for (int32_t z = 0; z < BrickField::stride; ++z) {
                    const bool matters = x < width + reach_ && y < width + reach_ && z < width + reach_;
                    const Values v = matters ? corner(accessor, low.offsetBy(x, y, z)) : field_.background;
                    const size_t at = static_cast<size_t>((x * BrickField::stride + y) * BrickField::stride + z);
                    for (size_t plane = 0; plane < static_cast<size_t>(field_.planes); ++plane)
                        values[plane * BrickField::corners + at] = v[plane];
                    if (!matters) continue;
                    for (size_t k = 0; k < 3; ++k) {
                        content.low[k] = std::min(content.low[k], v[k]);
                        content.high[k] = std::max(content.high[k], v[k]);
                    }
                    if (v != field_.background) used.extendBy(V3d(x, y, z));
                }
        content.constant = content.low == content.high;
        if (used.isEmpty()) return;
        // A corner influences the cells on both sides of it; with `nearest`, only the cell that begins at it.
        const V3d place((brick[0] - origin_[0]) * width, (brick[1] - origin_[1]) * width,
                        (brick[2] - origin_[2]) * width);
        support = Imath::Box3d(place + used.min - V3d(reach_), place + used.max + V3d(1));
        for (int k = 0; k < 3; ++k) {
            support.min[k] = std::max(support.min[k], place[k]);
            support.max[k] = std::min(support.max[k], place[k] + width);
        }
    }

    void drop_empty()
    {
        const auto is_background = [&](uint32_t e) {
            if ((e & 3) == BrickField::entry_content) {
                const BrickField::Content& content = field_.contents[e >> 2];
                return content.constant &&
                       std::equal(content.low.begin(), content.low.begin() + field_.planes, field_.background.begin());
            }
            return (e & 3) == BrickField::entry_node && std::ranges::all_of(field_.nodes[e >> 2], [](uint32_t child) {
                       return child == BrickField::entry_empty;
                   });
        };
        for (auto& node : field_.nodes)
            for (uint32_t& e : node)
                if (is_background(e)) e = BrickField::entry_empty;
        for (uint32_t& e : field_.root)
            if (is_background(e)) e = BrickField::entry_empty;
        if (std::ranges::all_of(field_.root, [](uint32_t e) { return e == BrickField::entry_empty; }))
            field_.contents.clear();
    }

    const GridType& grid_;
    const FieldLimits& limits_;
    std::string place_;
    const Progress& progress_;
    int32_t reach_; // 1: a cell uses corners one beyond its lowest; 0: its lowest corner alone (nearest)
    std::vector<Item> items_;
    std::array<int32_t, 3> origin_{}; // in bricks
    std::vector<Brick> bricks_;
    BrickField field_;
};

template <class GridType>
std::optional<BrickField> build_as(const openvdb::GridBase& grid, const FieldLimits& limits, bool nearest,
                                   const std::string& place, const Progress& progress, Coord& origin)
{
    if (!grid.isType<GridType>()) return std::nullopt;
    return Builder<GridType>(static_cast<const GridType&>(grid), limits, nearest, place, progress).build(origin);
}

} // namespace

BrickField make_brick_field(const openvdb::GridBase& grid, const FieldLimits& limits, bool nearest,
                            const std::string& place, const Progress& progress, Coord& origin)
{
    std::optional<BrickField> field = build_as<openvdb::FloatGrid>(grid, limits, nearest, place, progress, origin);
    if (!field) field = build_as<openvdb::DoubleGrid>(grid, limits, nearest, place, progress, origin);
    if (!field && limits.vectors) field = build_as<openvdb::Vec3SGrid>(grid, limits, nearest, place, progress, origin);
    if (!field && limits.vectors) field = build_as<openvdb::Vec3DGrid>(grid, limits, nearest, place, progress, origin);
    if (!field)
        throw InputError(place, fmt::format("{} as a grid of {}", limits.name, grid.valueType()),
                         limits.vectors ? "a grid of float, double, vec3s or vec3d" : "a grid of float or double");
    return std::move(*field);
}

} // namespace scree
