#include "render/equivalent/hull_inset.h"

#include "base/error.h"
#include "render/media/triangle_tree.h"

#include <Imath/ImathBox.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <set>
#include <vector>

namespace scree {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
constexpr int dim = Leaf::DIM;
constexpr float beyond =
    2; ///< Voxels on both sides of the level up to which the field is known: more than a cell's diagonal.

/// The depth of points below a hull. The hull's field tells whether a point is inside; a tree of its triangles gives
/// the distance from the surface, which is computed only for the few voxels near the level.
class Depth {
public:
    Depth(const GrainHull& hull, double level, const VoxelLattice& lattice, const Progress& progress)
        : hull_(hull), level_(level), lattice_(lattice)
    {
        Imath::Box3d box;
        for (const V3f& p : hull.surface.positions) box.extendBy(V3d(p));
        const V3d size = box.size();
        scale_ = std::ldexp(1.0, -std::ilogb(std::max({size.x, size.y, size.z})));
        const TriangleView view{hull.surface.positions, hull.surface.triangles};
        tree_ = TriangleTree({&view, 1}, scale_, progress);
    }

    /// Leaves of the lattice in which points may be deep enough.
    std::vector<openvdb::Coord> candidates() const
    {
        std::set<openvdb::Coord> found;
        const auto add = [&](const openvdb::CoordBBox& box) {
            const V3d low = (hull_.lattice.place(to_v3d(box.min())) - lattice_.origin) / lattice_.voxel,
                      high = (hull_.lattice.place(to_v3d(box.max())) - lattice_.origin) / lattice_.voxel;
            const auto leaf = [](double x) { return static_cast<int>(std::floor(x / dim)); };
            for (int x = leaf(low.x); x <= leaf(high.x + 1); ++x)
                for (int y = leaf(low.y); y <= leaf(high.y + 1); ++y)
                    for (int z = leaf(low.z); z <= leaf(high.z + 1); ++z) found.insert(openvdb::Coord(x, y, z));
        };
        const openvdb::FloatTree& tree = hull_.field->tree();
        for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) add(leaf->getNodeBoundingBox());
        auto tile = tree.cbeginValueOff();
        tile.setMaxDepth(openvdb::FloatTree::ValueOffCIter::LEAF_DEPTH - 1);
        for (; tile; ++tile)
            if (*tile < 0) add(tile.getBoundingBox());
        return {found.begin(), found.end()};
    }

    enum class Kind { outside, inside, mixed };

    /// Fills a leaf with level minus depth, in voxels: negative where a point is deep enough. Changes the leaf only if
    /// the result is `mixed`.
    Kind fill(Leaf& leaf) const
    {
        openvdb::tree::ValueAccessor<const openvdb::FloatTree> field(hull_.field->tree());
        const double to_corner = 0.5 * (dim - 1) * std::sqrt(3.0);
        const V3d first = to_v3d(leaf.origin()), middle = first + V3d(0.5 * (dim - 1));
        const double around = distance(middle);
        if (around < level_ - beyond - to_corner || (around > to_corner && !is_inside(field, middle)))
            return Kind::outside;
        if (around > level_ + beyond + to_corner) return Kind::inside;
        leaf.fill(beyond, false);
        for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
                for (int k = 0; k < dim;) {
                    const V3d place = first + V3d(i, j, k);
                    const bool inside = is_inside(field, place);
                    const double deep = distance(place), missing = inside ? level_ - deep : beyond;
                    // The next voxels of the row for which the same value holds: beyond the known band, or outside too.
                    int same = 1 + static_cast<int>(std::max(inside ? 0.0 : deep, std::abs(level_ - deep) - beyond));
                    for (; same > 0 && k < dim; --same, ++k) {
                        const auto offset = static_cast<openvdb::Index>((i * dim + j) * dim + k);
                        if (std::abs(missing) < beyond)
                            leaf.setValueOn(offset, static_cast<float>(missing));
                        else
                            leaf.setValueOff(offset, missing < 0 ? -beyond : beyond);
                    }
                }
        return Kind::mixed;
    }

private:
    static V3d to_v3d(const openvdb::Coord& c)
    {
        return {static_cast<double>(c.x()), static_cast<double>(c.y()), static_cast<double>(c.z())};
    }
    /// In voxels.
    double distance(const V3d& index) const
    {
        return tree_.distance(lattice_.place(index) * scale_) / (scale_ * lattice_.voxel);
    }
    bool is_inside(const openvdb::tree::ValueAccessor<const openvdb::FloatTree>& field, const V3d& index) const
    {
        const V3d at = (lattice_.place(index) - hull_.lattice.origin) / hull_.lattice.voxel;
        return field.getValue(openvdb::Coord::round(openvdb::Vec3d(at.x, at.y, at.z))) < 0;
    }

    const GrainHull& hull_;
    double level_; ///< in voxels
    VoxelLattice lattice_;
    double scale_ = 1;
    TriangleTree tree_;
};

} // namespace

std::optional<RegionSurface> inset_of_hull(const GrainHull& hull, double depth, const VoxelLattice& lattice,
                                           const Progress& progress)
{
    if (hull.surface.triangles.empty()) return std::nullopt;
    const Depth field(hull, depth / lattice.voxel, lattice, progress);
    const std::vector<openvdb::Coord> candidates = field.candidates();
    std::vector<std::unique_ptr<Leaf>> leaves(candidates.size());
    std::vector<Depth::Kind> kinds(candidates.size());
    std::atomic<size_t> done{0};
    tbb::parallel_for(size_t{0}, leaves.size(), [&](size_t i) {
        if (progress.cancelled()) return;
        leaves[i] = std::make_unique<Leaf>(candidates[i] << Leaf::LOG2DIM, beyond, false);
        kinds[i] = field.fill(*leaves[i]);
        if (kinds[i] != Depth::Kind::mixed) leaves[i].reset();
        if (const size_t n = ++done; n % 64 == 0)
            progress.update("core of the heap", static_cast<double>(n) / static_cast<double>(leaves.size()));
    });
    if (progress.cancelled()) throw Cancelled();
    const auto grid = openvdb::FloatGrid::create(beyond);
    grid->setGridClass(openvdb::GRID_LEVEL_SET); // volumeToMesh orients the surface by this class
    for (size_t i = 0; i < leaves.size(); ++i) {
        if (kinds[i] == Depth::Kind::inside)
            grid->tree().addTile(1, candidates[i] << Leaf::LOG2DIM, -beyond, false);
        else if (kinds[i] == Depth::Kind::mixed)
            grid->tree().addLeaf(leaves[i].release());
    }
    RegionSurface inset = level_surface(*grid, 0, lattice);
    progress.update("core of the heap", 1);
    if (inset.triangles.empty()) return std::nullopt;
    return inset;
}

} // namespace scree
