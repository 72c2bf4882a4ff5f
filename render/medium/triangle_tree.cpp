#include "render/medium/triangle_tree.h"

#include <limits>

namespace scree {

namespace {

/// What is waiting: the square of a distance, and a child's number.
struct Entry {
    float square;
    uint32_t child;
};

/// What may be lost, as a share of the distance, after so many blocks: near the middle of a ball all of its surface is as far, and looking for the
/// very nearest would visit it all.
constexpr double loss = 0x1p-12, large_loss = 0x1p-6;
constexpr int patience = 64;
constexpr float most_square = 0x1p100f; ///< that is told of: greater ones might overflow

} // namespace

inline std::array<float, TriangleTree::width> TriangleTree::squares(const Node& node, const V3d& place)
{
    // Let u = 2^-24: what is computed along an axis is off by less than 5 u of the sum of |q|'s components, which each gap is lowered by more than.
    std::array<float, width> square;
    for (size_t k = 0; k < width; ++k) {
        const auto x = static_cast<float>(place.x - double{node.middle[0][k]}), y = static_cast<float>(place.y - double{node.middle[1][k]}), z = static_cast<float>(place.z - double{node.middle[2][k]});
        const float rounding = 0x1p-21f * (std::abs(x) + std::abs(y) + std::abs(z));
        const auto gap = [&](size_t axis) {
            const float g = std::abs(node.axes[axis][0][k] * x + node.axes[axis][1][k] * y + node.axes[axis][2][k] * z) - rounding - node.half[axis][k];
            return g > 0 ? g : 0;
        };
        const float a = gap(0), b = gap(1), c = gap(2), sum = a * a + b * b + c * c;
        square[k] = sum < most_square ? sum : most_square;
    }
    return square;
}

double TriangleTree::distance(const V3d& place, uint32_t& block) const
{
    double best = std::numeric_limits<double>::infinity(), lost = loss;
    if (blocks_.empty()) return best;
    if (block != none) best = blocks_[block].distance(place);
    // Boxes' squares are off by less than 2^-20 of them (axes are off by 2^-25 in each component), and by what underflows.
    const auto limit_of = [&lost](double d) { return static_cast<float>(d * d * ((1 - lost) * (1 - lost) * (1 + 0x1p-19)) + 0x1p-118); };
    float limit = limit_of(best);
    Entry stack[deepest * (width - 1) + width];
    size_t waiting = 0;
    int visited = 0;
    uint32_t next = 0;
    for (;;) {
        if (next & leaf) {
            const uint32_t at = next & ~leaf;
            const double d = blocks_[at].distance(place);
            if (++visited == patience) lost = large_loss;
            if (d < best) {
                best = d;
                block = at;
            }
            limit = limit_of(best);
        } else {
            const Node& node = nodes_[next];
            const std::array<float, width> square = squares(node, place);
            // The nearest is left on top.
            size_t nearest = waiting;
            float least = std::numeric_limits<float>::infinity();
            for (size_t k = 0; k < node.count; ++k) {
                stack[waiting] = {square[k], node.child[k]};
                nearest = square[k] < least ? waiting : nearest;
                least = square[k] < least ? square[k] : least;
                waiting += square[k] < limit;
            }
            if (least < limit) std::swap(stack[nearest], stack[waiting - 1]);
        }
        do {
            if (waiting == 0) return best * ((1 - lost) * (1 - 0x1p-50));
            --waiting;
        } while (!(stack[waiting].square < limit));
        next = stack[waiting].child;
    }
}

V3d TriangleTree::nearest(uint32_t block, const V3d& place) const
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
