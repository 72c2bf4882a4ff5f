#include "render/media/triangle_tree.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace scree {

namespace {

/// The bits of the least square; their last three are replaced by its lane, which lowers the square by up to 2^-20. No
/// square is negative, so they are ordered like their bits.
inline uint32_t least_with_lane(const std::array<float, 8>& squares)
{
    std::array<uint32_t, 8> key = std::bit_cast<std::array<uint32_t, 8>>(squares);
    for (uint32_t k = 0; k < 8; ++k) key[k] = (key[k] & ~uint32_t{7}) | k;
    for (size_t k = 0; k < 4; ++k) key[k] = std::min(key[k], key[k + 4]);
    return std::min(std::min(key[0], key[2]), std::min(key[1], key[3]));
}

/// An entry of the search stack: a squared distance and a child's number.
struct Entry {
    float square;
    uint32_t child;
};

/// Allowed loss of the bound, as a part of the distance, after `patience` blocks. Near the middle of a ball all of its
/// surface is about equally far, and a search for the exact minimum would visit all of it.
constexpr double large_loss = 0x1p-6;
constexpr double float_loss = 0x1p-10; ///< part of the square that may be lost by using float instead of double
constexpr int patience = 64;
constexpr size_t most_entry_nodes = size_t{1} << 21;
constexpr float most_square = 0x1p100f; ///< larger squares are clamped to this, as they might overflow

} // namespace

inline std::array<float, TriangleTree::width> TriangleTree::squares(const Node& node, const SplitPlace& place)
{
    // Let u = 2^-24 and q the point relative to a box's middle. The error of q is below 3 u |q| plus place.rounding.
    // The error along an axis is below 8 u times the sum of |q|'s components; each gap is lowered by the sum of both.
    std::array<float, width> square;
    for (size_t k = 0; k < width; ++k) {
        const float x = (place.high.x - node.middle[0][k]) + place.low.x,
                    y = (place.high.y - node.middle[1][k]) + place.low.y,
                    z = (place.high.z - node.middle[2][k]) + place.low.z;
        const float rounding = 0x1p-20f * (std::abs(x) + std::abs(y) + std::abs(z)) + place.rounding;
        const auto gap = [&](size_t axis) {
            const float g =
                std::abs(node.axes[axis][0][k] * x + node.axes[axis][1][k] * y + node.axes[axis][2][k] * z) - rounding -
                node.half[axis][k];
            return g > 0 ? g : 0;
        };
        const float a = gap(0), b = gap(1), c = gap(2), sum = a * a + b * b + c * c;
        square[k] = sum < most_square ? sum : most_square;
    }
    return square;
}

inline double TriangleTree::nearer(const TriangleBlock& block, const V3d& place, double best)
{
    const TriangleBlock::Squares squares = block.squares(place);
    const uint32_t least = least_with_lane(squares.low);
    const double low = double{std::bit_cast<float>(least & ~uint32_t{7})};
    // Cases in which float is accurate enough.
    if (low >= best * best) return best;
    if (low > 0 && low >= double{squares.about[least & 7]} * (1 - float_loss)) return std::sqrt(low) * (1 - 0x1p-50);
    best = std::min(best, block.distance(least & 7, place));
    for (size_t k = 0; k < width; ++k)
        if (k != (least & 7) && double{squares.low[k]} < best * best) best = std::min(best, block.distance(k, place));
    return best;
}

TriangleTree::SplitPlace::SplitPlace(const V3d& place)
    : high(place), low(place - V3d(high)),
      rounding(static_cast<float>(0x1p-46 * (std::abs(place.x) + std::abs(place.y) + std::abs(place.z))))
{
}

TriangleTree::Entries TriangleTree::entries(const V3d& middle, double radius) const
{
    Entries found{0, 0, 0};
    if (blocks_.empty() || nodes_.size() > most_entry_nodes) return found;
    uint32_t block = none;
    distance(middle, block);
    const double nearest = (nearest_point(block, middle) - middle).length();
    const auto reach = static_cast<float>(std::pow(nearest + 2 * radius, 2) * (1 + 0x1p-18) + 0x1p-118);
    const SplitPlace split(middle);
    size_t count = 1;
    for (size_t at = 0; at < count;) {
        // Replaces a node by its children if all relevant children are nodes and few enough; the nearest comes first.
        const Node& node = nodes_[found[at]];
        const std::array<float, width> square = squares(node, split);
        std::array<Entry, width> near;
        size_t children = 0;
        bool down = true;
        for (size_t k = 0; k < width; ++k) {
            if (node.child[k] == 0 || !(square[k] <= reach)) continue;
            // Sorted by distance; ties by position in the node, which does not depend on the thread that built it.
            size_t to = children++;
            for (; to > 0 && near[to - 1].square > square[k]; --to) near[to] = near[to - 1];
            near[to] = {square[k], node.child[k]};
            down = down && !(node.child[k] & leaf);
        }
        if (!down || count - 1 + children > found.size()) {
            ++at;
            continue;
        }
        std::array<uint32_t, most_entries + width> list;
        size_t n = 0;
        for (size_t k = 0; k < at; ++k) list[n++] = found[k];
        for (size_t k = 0; k < children; ++k) list[n++] = near[k].child;
        for (size_t k = at + 1; k < count; ++k) list[n++] = found[k];
        count = n;
        std::copy_n(list.begin(), count, found.begin());
    }
    return found;
}

double TriangleTree::distance(const V3d& place, uint32_t& block, const Entries& from, double lost, double least) const
{
    double best = std::numeric_limits<double>::infinity();
    if (blocks_.empty()) return best;
    if (block != none) best = nearer(blocks_[block], place, best);
    // The relative error of the boxes' squares is below 2^-20 (axes have an error of 2^-25 in each component), plus
    // underflow.
    const auto limit_of = [&lost](double d) {
        return static_cast<float>(d * d * ((1 - lost) * (1 - lost) * (1 + 0x1p-19)) + 0x1p-118);
    };
    float limit = limit_of(best);
    Entry stack[deepest * (width - 1) + 2 * width + most_entries];
    size_t waiting = 0;
    // A 0 after the first entry means none: the root would be useless there.
    for (size_t k = most_entries; k-- > 1;)
        if (from[k]) stack[waiting++] = {0, from[k]};
    int visited = 0;
    uint32_t next = from[0];
    const SplitPlace split(place);
    for (;;) {
        if (next & leaf) {
            const uint32_t at = next & ~leaf;
            const double d = nearer(blocks_[at], place, best);
            if (++visited == patience) lost = std::max(lost, large_loss);
            if (d < best) {
                best = d;
                block = at;
                if (best <= least) return 0;
            }
            limit = limit_of(best);
        } else {
            const Node& node = nodes_[next];
            const std::array<float, width> square = squares(node, split);
            const uint32_t nearest = least_with_lane(square) & 7;
            // Without branches, which would often be mispredicted.
            for (uint32_t k = 0; k < width; ++k) {
                stack[waiting] = {square[k], node.child[k]};
                waiting += static_cast<size_t>(square[k] < limit) & static_cast<size_t>(k != nearest) &
                           static_cast<size_t>(node.child[k] != 0);
            }
            if (square[nearest] < limit && node.child[nearest] != 0) {
                next = node.child[nearest];
                continue;
            }
        }
        do {
            if (waiting == 0) return best * ((1 - lost) * (1 - 0x1p-50));
            --waiting;
        } while (!(stack[waiting].square < limit));
        next = stack[waiting].child;
    }
}

V3d TriangleTree::nearest_point(uint32_t block, const V3d& place) const
{
    V3d best(0);
    double least = std::numeric_limits<double>::infinity();
    for (size_t lane = 0; lane < TriangleBlock::lanes; ++lane) {
        const V3d p = blocks_[block].nearest(lane, place);
        if (!((p - place).length2() < least)) continue;
        least = (p - place).length2();
        best = p;
    }
    return best;
}

} // namespace scree
