#pragma once

#include "base/math.h"
#include "base/progress.h"
#include "render/media/triangle_block.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Triangles over positions that live elsewhere.
struct TriangleView {
    std::span<const V3f> positions;
    std::span<const std::array<uint32_t, 3>> triangles;
};

/// Finds how far it is from a place to the nearest of many triangles, of which it keeps its own copy.
///
/// A tree of boxes, eight a node, over blocks of up to eight triangles. Boxes lie along what is in them (Gottschalk,
/// Lin and Manocha 1996): those of a smooth surface are thin, and few of them are as near as the nearest triangle.
class TriangleTree {
public:
    static constexpr uint32_t none = ~uint32_t{0};

    TriangleTree() = default;
    /// scale: a power of two that brings places that are asked about to a range about 1 wide. Throws InputError (a
    /// corner that is missing, not finite, or not below 2^100 scaled), Cancelled.
    TriangleTree(std::span<const TriangleView> meshes, double scale, const Progress& progress);

    bool empty() const { return blocks_.empty(); }
    /// Nodes that hold all that can be nearest to some places; a 0 after the first is none.
    static constexpr size_t most_entries = 3;
    using Entries = std::array<uint32_t, most_entries>;
    /// For places in a ball; below 2^21.
    Entries entries(const V3d& middle, double radius) const;
    /// A lower bound of the scaled distance from a scaled place; mostly 2^-12 of it below, at most 2^-6. Infinite where
    /// there are no triangles.
    double distance(const V3d& place, const Entries& from = {0, 0, 0}) const
    {
        uint32_t block = none;
        return distance(place, block, from);
    }
    /// Likewise but 2^-4 below, and 0 where it is not more than `least`.
    double rough_distance(const V3d& place, const Entries& from, double least) const
    {
        uint32_t block = none;
        return distance(place, block, from, rough_loss, least);
    }
    /// block: where it is likely to be found, or none; becomes where it was found.
    double distance(const V3d& place, uint32_t& block, const Entries& from = {0, 0, 0}) const
    {
        return distance(place, block, from, loss, 0);
    }
    /// About the point of a block's triangles that is nearest to a place.
    V3d nearest_point(uint32_t block, const V3d& place) const;
    uint64_t bytes() const { return nodes_.size() * sizeof(Node) + blocks_.size() * sizeof(TriangleBlock); }

private:
    friend class TriangleTreeBuilder;
    static constexpr size_t width = 8;
    static constexpr uint32_t leaf = uint32_t{1} << 31; ///< of a child's number: that of a block
    static constexpr size_t deepest = 60;
    /// What may be lost, as a share of the distance.
    static constexpr double loss = 0x1p-12, rough_loss = 0x1p-4;

    struct alignas(64) Node {
        using Lanes = std::array<float, width>;

        std::array<Lanes, 3> middle{}; ///< by axis
        std::array<std::array<Lanes, 3>, 3> axes{}; ///< rows: nearly unit vectors along the box's edges
        std::array<Lanes, 3>
            half{}; ///< of the edges; very negative where there is no child, so that this is never the nearest
        std::array<uint32_t, width> child{}; ///< 0: none, which are the last
    };

    /// A place as the sum of two in float.
    struct SplitPlace {
        V3f high, low;
        float rounding; ///< at least what the sum is off by

        explicit SplitPlace(const V3d& place);
    };

    double distance(const V3d& place, uint32_t& block, const Entries& from, double lost, double least) const;
    /// Lower bounds of the squares of the distances from a place to a node's boxes.
    static std::array<float, width> squares(const Node& node, const SplitPlace& place);
    /// The distance to the block's triangles, or `best` where that is less.
    static double nearer(const TriangleBlock& block, const V3d& place, double best);

    std::vector<Node> nodes_; ///< the first is the root
    std::vector<TriangleBlock> blocks_;
};

} // namespace scree
