#pragma once

#include "base/math.h"
#include "base/progress.h"
#include "render/media/triangle_block.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// A view of triangles and positions that are owned elsewhere.
struct TriangleView {
    std::span<const V3f> positions;
    std::span<const std::array<uint32_t, 3>> triangles;
};

/// Finds the distance from a point to the nearest of many triangles; keeps its own copy of the triangles.
///
/// A tree of boxes, eight per node, over blocks of up to eight triangles. The boxes are oriented along their triangles
/// (Gottschalk, Lin and Manocha 1996): on a smooth surface they are thin, so that few boxes are as near as the nearest
/// triangle.
class TriangleTree {
public:
    static constexpr uint32_t none = ~uint32_t{0};

    TriangleTree() = default;
    /// scale: a power of two that scales the query points to a range about 1 wide. Throws InputError (a corner that is
    /// missing, not finite, or not below 2^100 after scaling), Cancelled.
    TriangleTree(std::span<const TriangleView> meshes, double scale, const Progress& progress);

    bool empty() const { return blocks_.empty(); }
    /// Nodes from which a search can start: together they hold every triangle that can be nearest. A 0 after the first
    /// means none.
    static constexpr size_t most_entries = 3;
    using Entries = std::array<uint32_t, most_entries>;
    /// The entries for all points in a ball; each is below 2^21.
    Entries entries(const V3d& middle, double radius) const;
    /// A lower bound of the scaled distance from a scaled point: mostly 2^-12 of the distance below it, at most 2^-6.
    /// Infinite if there are no triangles.
    double distance(const V3d& place, const Entries& from = {0, 0, 0}) const
    {
        uint32_t block = none;
        return distance(place, block, from);
    }
    /// The same with a loss of 2^-4 of the distance; 0 where the distance is `least` or less.
    double rough_distance(const V3d& place, const Entries& from, double least) const
    {
        uint32_t block = none;
        return distance(place, block, from, rough_loss, least);
    }
    /// block: in: a block that is likely to hold the nearest triangle, or `none`; out: the block that holds it.
    double distance(const V3d& place, uint32_t& block, const Entries& from = {0, 0, 0}) const
    {
        return distance(place, block, from, loss, 0);
    }
    /// The point of a block's triangles that is nearest to a given point, up to rounding.
    V3d nearest_point(uint32_t block, const V3d& place) const;
    uint64_t bytes() const { return nodes_.size() * sizeof(Node) + blocks_.size() * sizeof(TriangleBlock); }

private:
    friend class TriangleTreeBuilder;
    static constexpr size_t width = 8;
    static constexpr uint32_t leaf = uint32_t{1} << 31; ///< bit of a child's number: the child is a block
    static constexpr size_t deepest = 60;
    /// Allowed loss of the bound, as a part of the distance.
    static constexpr double loss = 0x1p-12, rough_loss = 0x1p-4;

    struct alignas(64) Node {
        using Lanes = std::array<float, width>;

        std::array<Lanes, 3> middle{}; ///< by axis
        std::array<std::array<Lanes, 3>, 3> axes{}; ///< rows: nearly unit vectors along the box's edges
        std::array<Lanes, 3> half{}; ///< half the edges; very negative where there is no child
        std::array<uint32_t, width> child{}; ///< 0: no child; these come last
    };

    /// A point as the sum of two float vectors.
    struct SplitPlace {
        V3f high, low;
        float rounding; ///< at least the error of the sum

        explicit SplitPlace(const V3d& place);
    };

    double distance(const V3d& place, uint32_t& block, const Entries& from, double lost, double least) const;
    /// Lower bounds of the squared distances from a point to a node's boxes.
    static std::array<float, width> squares(const Node& node, const SplitPlace& place);
    /// The distance to the block's triangles, or `best` if that is smaller.
    static double nearer(const TriangleBlock& block, const V3d& place, double best);

    std::vector<Node> nodes_; ///< the first is the root
    std::vector<TriangleBlock> blocks_;
};

} // namespace scree
