#include "render/equivalent/grain_hull.h"

#include "base/error.h"
#include "render/equivalent/sphere_bins.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <bitset>
#include <cmath>

namespace scree {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using Spheres = std::span<const GrainStore::Sphere>;

/// voxels along an edge: a sphere overlaps few blocks, and a block's values fit into the cache
constexpr int block = 32;
constexpr int leaves_along = block / static_cast<int>(Leaf::DIM);
constexpr size_t leaves_in_block = leaves_along * leaves_along * leaves_along;
/// voxels outside the union up to which distances are known: more than a cell's diagonal
constexpr double beyond = 1.75;

struct BlockValues {
    std::array<float, size_t{block} * block * block> distance{}; ///< in voxels
    std::bitset<leaves_in_block> touched;
};

/// A leaf of one block, not yet in a tree.
struct FoundLeaf {
    std::unique_ptr<Leaf> leaf;
    bool inside; ///< whether all of it is inside
};

class Dilation {
public:
    Dilation(Spheres spheres, double more, const VoxelLattice& lattice)
        : spheres_(spheres), more_(more / lattice.voxel), lattice_(lattice)
    {
    }

    bool range(uint32_t sphere, SphereBins::Voxel& first, SphereBins::Voxel& last) const
    {
        if (!(spheres_[sphere].r > 0)) return false;
        const V3d c = centre(sphere);
        const double reach = radius(sphere) + beyond;
        for (int k = 0; k < 3; ++k) {
            const double at = std::clamp(c[k], -0x1p60, 0x1p60);
            first[static_cast<size_t>(k)] = std::llround(std::ceil(at - reach));
            last[static_cast<size_t>(k)] = std::llround(std::floor(at + reach));
        }
        return true;
    }

    void fill(const SphereBins::Bin& bin, BlockValues& values) const
    {
        values.touched.reset();
        for (const SphereBins::Entry& entry : bin.entries) {
            V3d c = centre(entry.sphere);
            for (int k = 0; k < 3; ++k) c[k] -= static_cast<double>(bin.block[static_cast<size_t>(k)] * block);
            lower(c, radius(entry.sphere), values);
        }
    }

private:
    V3d centre(uint32_t i) const { return lattice_.index({spheres_[i].x, spheres_[i].y, spheres_[i].z}); }
    double radius(uint32_t i) const { return spheres_[i].r / lattice_.voxel + more_; }

    static void touch(const int (&first)[3], const int (&last)[3], BlockValues& values)
    {
        constexpr int dim = Leaf::DIM;
        for (int x = first[0] / dim; x <= last[0] / dim; ++x)
            for (int y = first[1] / dim; y <= last[1] / dim; ++y)
                for (int z = first[2] / dim; z <= last[2] / dim; ++z) {
                    const auto leaf = static_cast<size_t>((x * leaves_along + y) * leaves_along + z);
                    if (values.touched[leaf]) continue;
                    values.touched.set(leaf);
                    for (int i = 0; i < dim; ++i)
                        for (int j = 0; j < dim; ++j)
                            std::fill_n(&values.distance[static_cast<size_t>(
                                            ((x * dim + i) * block + y * dim + j) * block + z * dim)],
                                        dim, static_cast<float>(beyond));
                }
    }

    static void lower(const V3d& c, double radius, BlockValues& values)
    {
        const double reach = radius + beyond;
        int first[3], last[3];
        for (int k = 0; k < 3; ++k) {
            first[k] = static_cast<int>(std::ceil(std::max(c[k] - reach, 0.0)));
            last[k] = static_cast<int>(std::floor(std::min(c[k] + reach, block - 1.0)));
            if (first[k] > last[k]) return;
        }
        touch(first, last, values);
        const auto r = static_cast<float>(radius);
        const auto zc = static_cast<float>(c.z);
        for (int x = first[0]; x <= last[0]; ++x)
            for (int y = first[1]; y <= last[1]; ++y) {
                const double across = (x - c.x) * (x - c.x) + (y - c.y) * (y - c.y), left = reach * reach - across;
                if (left < 0) continue;
                const double half = std::sqrt(left);
                const int begin = std::max(first[2], static_cast<int>(std::ceil(c.z - half))),
                          end = std::min(last[2], static_cast<int>(std::floor(c.z + half)));
                float* row = &values.distance[static_cast<size_t>((x * block + y) * block)];
                const auto squared = static_cast<float>(across);
                for (int z = begin; z <= end; ++z) {
                    const float dz = static_cast<float>(z) - zc, distance = std::sqrt(squared + dz * dz) - r;
                    row[z] = std::min(row[z], distance);
                }
            }
    }

    Spheres spheres_;
    double more_; ///< in voxels
    VoxelLattice lattice_;
};

std::vector<FoundLeaf> to_leaves(const SphereBins::Bin& bin, const BlockValues& values)
{
    constexpr int dim = Leaf::DIM;
    std::vector<FoundLeaf> leaves;
    for (size_t n = 0; n < leaves_in_block; ++n) {
        if (!values.touched[n]) continue;
        const int index = static_cast<int>(n), x = index / (leaves_along * leaves_along) * dim,
                  y = index / leaves_along % leaves_along * dim, z = index % leaves_along * dim;
        const auto first = [&](size_t k) { return static_cast<int>(bin.block[k] * block); };
        auto leaf = std::make_unique<Leaf>(openvdb::Coord(first(0) + x, first(1) + y, first(2) + z),
                                           static_cast<float>(beyond), false);
        bool inside = true, any = false;
        for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j)
                for (int k = 0; k < dim; ++k) {
                    const float value = values.distance[static_cast<size_t>(((x + i) * block + y + j) * block + z + k)];
                    if (value < static_cast<float>(beyond))
                        leaf->setValueOn(static_cast<openvdb::Index>((i * dim + j) * dim + k), value), any = true;
                    inside = inside && value < 0;
                }
        if (any) leaves.push_back({std::move(leaf), inside});
    }
    return leaves;
}

/// Puts the leaves into one tree. An inside leaf whose neighbours are all inside too becomes a tile, as no surface is
/// near it.
openvdb::FloatGrid::Ptr gather(std::vector<std::vector<FoundLeaf>>& leaves)
{
    const auto cell = [](const FoundLeaf& found) { return found.leaf->origin() >> Leaf::LOG2DIM; };
    openvdb::MaskTree inside;
    for (const auto& of_block : leaves)
        for (const FoundLeaf& found : of_block)
            if (found.inside) inside.setValueOn(cell(found));
    auto grid = openvdb::FloatGrid::create(static_cast<float>(beyond));
    grid->setGridClass(openvdb::GRID_LEVEL_SET); // volumeToMesh orients the surface by this class
    openvdb::tree::ValueAccessor<const openvdb::MaskTree> is_inside(inside);
    for (auto& of_block : leaves) {
        for (FoundLeaf& found : of_block) {
            bool deep = found.inside;
            for (int k = 0; deep && k < 27; ++k)
                deep = is_inside.isValueOn(cell(found).offsetBy(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1));
            if (deep)
                grid->tree().addTile(1, found.leaf->origin(), -static_cast<float>(beyond), false);
            else
                grid->tree().addLeaf(found.leaf.release());
        }
        of_block.clear();
    }
    return grid;
}

} // namespace

GrainHull dilated_spheres(Spheres spheres, double more, const VoxelLattice& lattice, const Progress& progress)
{
    openvdb::initialize();
    const Dilation dilation(spheres, more, lattice);
    const SphereBins bins(
        static_cast<uint32_t>(spheres.size()), block,
        [&](uint32_t i, SphereBins::Voxel& first, SphereBins::Voxel& last) { return dilation.range(i, first, last); });
    if (progress.cancelled()) throw Cancelled();
    std::vector<std::vector<FoundLeaf>> leaves(bins.bins().size());
    tbb::enumerable_thread_specific<std::unique_ptr<BlockValues>> workspaces(
        [] { return std::make_unique<BlockValues>(); });
    std::atomic<uint64_t> done{0};
    tbb::parallel_for(size_t{0}, leaves.size(), [&](size_t i) {
        if (progress.cancelled()) return;
        BlockValues& values = *workspaces.local();
        dilation.fill(bins.bins()[i], values);
        leaves[i] = to_leaves(bins.bins()[i], values);
        if (const uint64_t n = ++done; n % 64 == 0)
            progress.update("hull of the heap", static_cast<double>(n) / static_cast<double>(leaves.size()));
    });
    if (progress.cancelled()) throw Cancelled();
    GrainHull hull{gather(leaves), lattice, {}};
    hull.surface = level_surface(*hull.field, 0, lattice);
    progress.update("hull of the heap", 1);
    return hull;
}

} // namespace scree
