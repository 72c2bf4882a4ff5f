#include "packing/solids/distance_field.h"

#include "base/error.h"
#include "packing/solids/near_triangles.h"
#include "packing/solids/surface_tree.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace scree {

namespace {

using Imath::V3d;
using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double band = 2.5; ///< voxels on either side of the surface whose distances are kept
constexpr int block = Leaf::DIM; ///< voxels along a block's edge
static_assert(block == 8);

/// The grid of voxels in space: the centre of voxel i is origin + (i + 1/2) voxel, rounded; the voxel's value belongs
/// to that rounded place.
struct Lattice {
    V3d origin{0};
    double voxel = 1;

    /// Computed in voxels, where squares neither overflow nor underflow in any unit.
    double between(const V3d& a, const V3d& b) const { return ((a - b) / voxel).length() * voxel; }
    V3d place(const V3d& index) const { return origin + index * voxel; }
    V3d centre(const openvdb::Coord& c) const { return place(V3d(c.x() + 0.5, c.y() + 0.5, c.z() + 0.5)); }
};

/// The values of a block: distances in voxels, negative inside (OpenVDB's convention). A voxel that is not active holds
/// a lower bound of its distance.
struct Block {
    bool whole = true; ///< one value, value[0], not active
    std::array<float, block * block * block> value{};
    std::array<bool, block * block * block> active{};
};

/// What one thread needs to fill a block: the triangles near the block, its halves and its quarters.
struct Workspace {
    std::vector<Corners> triangles;
    std::array<NearTriangles, 3> near;
};

/// Subdivides blocks down to voxels. A cube is not subdivided further if the surface is farther than the band from the
/// centres of all its voxels; these centres are then on the same side as the cube's middle. The middle of a smaller
/// cube is also on that side if it lies in the ball around the larger cube's middle that the surface does not enter;
/// otherwise exact arithmetic decides.
class BlockFiller {
public:
    BlockFiller(const SurfaceTree& surface, const Lattice& lattice, double slack, double scale)
        : surface_(surface), lattice_(lattice), slack_(slack), scale_(scale)
    {
    }

    void fill(const openvdb::Coord& first, Workspace& work, Block& result) const
    {
        const V3d place = middle_of(first, block);
        const Middle middle{place, surface_.rough_distance(place, 0.1), surface_.encloses(place)};
        result.whole = is_clear(middle, block);
        if (result.whole) {
            result.value[0] = value(clearance(middle, block), middle.inside);
            return;
        }
        work.triangles.clear();
        surface_.collect_near(place, reach_of_nearest(middle, block), work.triangles);
        work.near[0].fill(work.triangles, scale_);
        split(first, block, middle, work, 0, result);
    }

private:
    struct Middle {
        V3d place;
        DistanceBounds distance; ///< unsigned
        bool inside;
    };

    V3d middle_of(const openvdb::Coord& first, int edge) const
    {
        const double half = 0.5 * edge;
        return lattice_.place(V3d(first.x() + half, first.y() + half, first.z() + half));
    }

    /// Distance from a cube's middle to the farthest of its voxels' centres; the middles of smaller cubes are nearer.
    double half_diagonal(int edge) const
    {
        return std::sqrt(0.75) * (edge - 1) * lattice_.voxel * (1 + 1e-12) + slack_;
    }

    /// A lower bound on the surface's distance from the centres of a cube's voxels.
    double clearance(const Middle& middle, int edge) const { return middle.distance.lo - half_diagonal(edge); }

    bool is_clear(const Middle& middle, int edge) const { return clearance(middle, edge) >= band * lattice_.voxel; }

    /// The greatest distance from a cube's middle of a triangle that is nearest to the centre of one of its voxels.
    double reach_of_nearest(const Middle& middle, int edge) const
    {
        return middle.distance.hi + 2 * half_diagonal(edge);
    }

    float value(double distance, bool inside) const
    {
        const auto voxels = static_cast<float>(distance / lattice_.voxel);
        return inside ? -voxels : voxels;
    }

    Middle look_at(const V3d& place, const Middle& larger, NearTriangles& near) const
    {
        Middle found{place, near.distance(place), larger.inside};
        if (!(found.distance.hi - found.distance.lo <= slack_))
            found.distance.lo = found.distance.hi = surface_.distance(place);
        const double step = lattice_.between(place, larger.place) * (1 + 1e-12);
        if (!(step + slack_ < larger.distance.lo)) found.inside = surface_.encloses(place);
        return found;
    }

    void split(const openvdb::Coord& first, int edge, const Middle& middle, Workspace& work, size_t depth,
               Block& result) const
    {
        const int half = edge / 2;
        NearTriangles& near = work.near[depth];
        for (int child = 0; child < 8; ++child) {
            const openvdb::Coord corner =
                first.offsetBy(child & 4 ? half : 0, child & 2 ? half : 0, child & 1 ? half : 0);
            const Middle found = look_at(middle_of(corner, half), middle, near);
            const bool clear = is_clear(found, half);
            if (half > 1 && !clear) {
                work.near[depth + 1].pick(near, reach_of_nearest(found, half));
                split(corner, half, found, work, depth + 1, result);
                continue;
            }
            const float filling =
                value(clear ? clearance(found, half) : found.distance.lo / 2 + found.distance.hi / 2, found.inside);
            for (int x = 0; x < half; ++x)
                for (int y = 0; y < half; ++y)
                    for (int z = 0; z < half; ++z) {
                        const auto offset = Leaf::coordToOffset(corner.offsetBy(x, y, z));
                        result.value[offset] = filling;
                        result.active[offset] = !clear;
                    }
        }
    }

    const SurfaceTree& surface_;
    const Lattice& lattice_;
    double slack_, scale_;
};

} // namespace

struct DistanceField::Impl {
    openvdb::FloatTree tree{static_cast<float>(band)};
    Lattice lattice;
    Imath::Box3d bounds; ///< of the domain
    openvdb::Coord voxels; ///< along each axis
    double slack = 0; ///< error bound of distances: from the rounding of distances and of places
    double error = 0; ///< slack plus the rounding of values to float

    void choose_lattice(int cells);
    void fill(const SurfaceTree& surface);
};

void DistanceField::Impl::choose_lattice(int cells)
{
    const V3d size = bounds.size();
    const double longest = std::max({size.x, size.y, size.z});
    const double farthest = std::max({std::abs(bounds.min.x), std::abs(bounds.min.y), std::abs(bounds.min.z),
                                      std::abs(bounds.max.x), std::abs(bounds.max.y), std::abs(bounds.max.z)});
    lattice.voxel = longest / cells;
    // Beyond the band around the bounds, the bounds alone give the distance well enough.
    const double margin = band + 1;
    lattice.origin = bounds.min - V3d(margin * lattice.voxel);
    for (int k = 0; k < 3; ++k) voxels[k] = static_cast<int>(std::ceil(size[k] / lattice.voxel + 2 * margin));
    slack = 1e-13 * longest + 0x1p-49 * farthest;
    // Values below 2^30 voxels that are active are below the band's.
    error = slack + 1e-6 * lattice.voxel;
}

void DistanceField::Impl::fill(const SurfaceTree& surface)
{
    const int exponent = std::ilogb(lattice.voxel * std::max({voxels.x(), voxels.y(), voxels.z()}));
    const BlockFiller filler(surface, lattice, slack, std::ldexp(1.0, std::clamp(-exponent, -1022, 1022)));
    tbb::enumerable_thread_specific<Workspace> workspaces;
    const openvdb::Coord blocks((voxels.x() + block - 1) / block, (voxels.y() + block - 1) / block,
                                (voxels.z() + block - 1) / block);
    // One layer of blocks at a time, so that few blocks wait for insertion into the tree.
    const auto across = static_cast<size_t>(blocks.y()) * static_cast<size_t>(blocks.z());
    std::vector<Block> layer(across);
    for (int x = 0; x < blocks.x(); ++x) {
        const auto corner = [&](size_t k) {
            const auto y = static_cast<int>(k / static_cast<size_t>(blocks.z())),
                       z = static_cast<int>(k % static_cast<size_t>(blocks.z()));
            return openvdb::Coord(x * block, y * block, z * block);
        };
        tbb::parallel_for(size_t{0}, across, [&](size_t k) { filler.fill(corner(k), workspaces.local(), layer[k]); });
        for (size_t k = 0; k < across; ++k) {
            const Block& b = layer[k];
            if (b.whole) {
                tree.addTile(1, corner(k), b.value[0], false);
                continue;
            }
            auto leaf = std::make_unique<Leaf>(corner(k), b.value[0], false);
            for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
                leaf->setValueOnly(i, b.value[i]);
                leaf->setActiveState(i, b.active[i]);
            }
            tree.addLeaf(leaf.release());
        }
    }
}

DistanceField::DistanceField(const Domain& domain, int cells) : impl_(std::make_unique<Impl>())
{
    if (cells < 1 || cells > 4096) throw InputError("distance field", fmt::format("{} cells", cells), "1 to 4096");
    openvdb::initialize();
    impl_->bounds = domain.bounds();
    impl_->choose_lattice(cells);
    impl_->fill(domain.surface());
}

DistanceField::~DistanceField() = default;

DistanceField::Interval DistanceField::signed_distance(const V3d& point) const
{
    const Impl& f = *impl_;
    const Lattice& lattice = f.lattice;
    const V3d index = (point - lattice.origin) / lattice.voxel;
    for (int k = 0; k < 3; ++k) {
        if (index[k] >= 0 && index[k] < f.voxels[k]) continue;
        if (std::isnan(index[k])) return {-infinity, infinity};
        const double beyond = std::max(f.bounds.min[k] - point[k], point[k] - f.bounds.max[k]);
        return {-infinity, -std::max(beyond, 0.0)};
    }
    const openvdb::Coord voxel(static_cast<int>(index.x), static_cast<int>(index.y), static_cast<int>(index.z));
    float value;
    const bool active = f.tree.probeValue(voxel, value);
    // The distance is 1-Lipschitz: it differs from the value at the voxel's centre by at most this.
    const double away = lattice.between(point, lattice.centre(voxel)) * (1 + 1e-12) + f.error;
    const double distance = -static_cast<double>(value) * lattice.voxel;
    if (active) return {distance - away, distance + away};
    return distance > 0 ? Interval{distance * (1 - 1e-6) - away, infinity}
                        : Interval{-infinity, distance * (1 - 1e-6) + away};
}

uint64_t DistanceField::bytes() const { return impl_->tree.memUsage(); }

} // namespace scree
