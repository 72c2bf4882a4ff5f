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

} // namespace

double TriangleTree::distance(const V3d& place, uint32_t& block) const
{
    double best = std::numeric_limits<double>::infinity(), lost = loss;
    if (blocks_.empty()) return best;
    if (block != none) best = blocks_[block].distance(place);
    // Boxes' squares are off by less than 2^-20 of them, and by what underflows.
    const auto limit_of = [&lost](double d) { return static_cast<float>(d * d * ((1 - lost) * (1 - lost) * (1 + 0x1p-19)) + 0x1p-118); };
    float limit = limit_of(best);
    // The places on both sides of this one in float, so that gaps are off by a share of them only.
    float below[3], above[3];
    for (int k = 0; k < 3; ++k) {
        const auto rounded = static_cast<float>(place[k]);
        below[k] = rounded - std::abs(rounded) * 0x1p-23f;
        above[k] = rounded + std::abs(rounded) * 0x1p-23f;
    }
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
            std::array<float, width> square;
            for (size_t k = 0; k < width; ++k) {
                const auto gap = [&](size_t axis) {
                    const float low = node.lo[axis][k] - above[axis], high = below[axis] - node.hi[axis][k], most = low > high ? low : high;
                    return most > 0 ? most : 0;
                };
                const float x = gap(0), y = gap(1), z = gap(2);
                square[k] = x * x + y * y + z * z;
            }
            // The nearest is left on top.
            size_t nearest = waiting;
            float least = std::numeric_limits<float>::infinity();
            for (size_t k = 0; k < width; ++k) {
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
