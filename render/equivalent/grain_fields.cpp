#include "render/equivalent/grain_fields.h"

#include "base/error.h"
#include "render/equivalent/grain_field_grids.h"
#include "render/equivalent/sphere_bins.h"

#include <fmt/format.h>
#include <openvdb/tools/Interpolation.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <atomic>
#include <cmath>

namespace scree {

namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;
using Spheres = std::span<const GrainStore::Sphere>;

constexpr int block = Leaf::DIM;
constexpr double largest_point =
    0.5; ///< radius in voxels up to which a sphere is spread as one point; alone it fills a fifth of its voxel

/// Points of a cubic lattice around a large sphere's centre; each is weighted by roughly the part of its cell that is
/// inside the sphere.
struct Filling {
    uint32_t sphere = 0;
    int reach = 0; ///< points along an axis to either side
    double step = 0; ///< step of the lattice, in voxels: at most 1/2, so that the sum of splines is smooth
    double radius = 0; ///< in steps
    double scale = 1; ///< makes the weights sum to 1

    Filling(uint32_t index, double radius_in_voxels) : sphere(index)
    {
        const double inner = std::ceil(2 * radius_in_voxels - 0.5);
        radius = inner + 0.5;
        step = radius_in_voxels / radius;
        reach = static_cast<int>(inner);
        double sum = 0;
        for (int x = -reach; x <= reach; ++x)
            for (int y = -reach; y <= reach; ++y)
                for (int z = -reach; z <= reach; ++z) sum += weight(x, y, z);
        scale = 1 / sum;
    }

    double weight(int x, int y, int z) const
    {
        const double distance = std::sqrt(static_cast<double>(x * x + y * y + z * z));
        return scale * std::clamp(radius - distance + 0.5, 0.0, 1.0);
    }
};

/// Sums of r^2, r^3 and r^4 for one type in a block, all in voxels.
struct TypeSums {
    bool used = false;
    std::array<std::array<double, Leaf::SIZE>, 3> moment{};
};

/// The leaves of one block.
struct BlockLeaves {
    struct Type {
        size_t type;
        std::array<std::unique_ptr<Leaf>, 3> moment;
    };
    std::vector<Type> types;
    std::unique_ptr<Leaf> pack_rate;
};

class Spreader {
public:
    Spreader(Spheres spheres, std::span<const uint8_t> codes, const FloatMargin& margin, double voxel)
        : spheres_(spheres), codes_(codes), margin_(margin), voxel_(voxel)
    {
        for (uint32_t i = 0; i < spheres.size(); ++i) {
            const double r = radius(i);
            if (r > largest_point) fillings_.emplace_back(i, r);
        }
    }

    /// The voxels to which a sphere contributes.
    bool range(uint32_t sphere, SphereBins::Voxel& first, SphereBins::Voxel& last) const
    {
        const double r = radius(sphere);
        if (!(r > 0)) return false;
        const double around = 1 + (r > largest_point ? r : 0);
        const V3d c = centre(sphere);
        for (int k = 0; k < 3; ++k) {
            // Limited for the conversion; SphereBins refuses such values.
            const double at = std::clamp(c[k], -0x1p60, 0x1p60);
            first[static_cast<size_t>(k)] = std::llround(std::floor(at - around + 0.5));
            last[static_cast<size_t>(k)] = std::llround(std::floor(at + around + 0.5));
        }
        return true;
    }

    void spread(const SphereBins::Bin& bin, const std::vector<int>& type_of, std::vector<TypeSums>& sums) const
    {
        for (const SphereBins::Entry& entry : bin.entries) {
            TypeSums& to = sums[static_cast<size_t>(type_of[codes_[entry.sphere]])];
            to.used = true;
            // In the block's own voxels.
            V3d c = centre(entry.sphere);
            for (int k = 0; k < 3; ++k) c[k] -= static_cast<double>(bin.block[static_cast<size_t>(k)] * block);
            const double r = radius(entry.sphere);
            const double moment[3] = {r * r, r * r * r, r * r * r * r};
            if (r > largest_point)
                fill(c, moment, filling(entry.sphere), to);
            else
                add_point(c, moment, to);
        }
    }

private:
    V3d centre(uint32_t i) const
    {
        const GrainStore::Sphere& s = spheres_[i];
        return {s.x / voxel_, s.y / voxel_, s.z / voxel_};
    }
    double radius(uint32_t i) const { return spheres_[i].r > 0 ? margin_.narrow(spheres_[i].r) / voxel_ : 0; }

    const Filling& filling(uint32_t sphere) const
    {
        return *std::lower_bound(fillings_.begin(), fillings_.end(), sphere,
                                 [](const Filling& f, uint32_t s) { return f.sphere < s; });
    }

    static void fill(const V3d& c, const double (&moment)[3], const Filling& f, TypeSums& to)
    {
        // Only the points that contribute to this block.
        int first[3], last[3];
        for (int k = 0; k < 3; ++k) {
            first[k] =
                std::max(-f.reach, static_cast<int>(std::ceil(std::max((-1.5 - c[k]) / f.step, -1.0 - f.reach))));
            last[k] =
                std::min(f.reach, static_cast<int>(std::floor(std::min((block + 0.5 - c[k]) / f.step, 1.0 + f.reach))));
        }
        for (int x = first[0]; x <= last[0]; ++x)
            for (int y = first[1]; y <= last[1]; ++y)
                for (int z = first[2]; z <= last[2]; ++z) {
                    const double w = f.weight(x, y, z);
                    if (w == 0) continue;
                    const double part[3] = {w * moment[0], w * moment[1], w * moment[2]};
                    add_point(c + V3d(x, y, z) * f.step, part, to);
                }
    }

    /// Adds to the voxels of this block only; the others of the 27 voxels get their part when their own block is
    /// filled.
    static void add_point(const V3d& c, const double (&moment)[3], TypeSums& to)
    {
        double weight[3][3];
        int first[3], begin[3], end[3];
        for (int k = 0; k < 3; ++k) {
            const double nearest = std::floor(c[k] + 0.5), u = c[k] - nearest;
            weight[k][0] = 0.5 * (0.5 - u) * (0.5 - u);
            weight[k][2] = 0.5 * (0.5 + u) * (0.5 + u);
            weight[k][1] = 1 - weight[k][0] - weight[k][2];
            first[k] = static_cast<int>(nearest) - 1;
            begin[k] = std::max(0, -first[k]);
            end[k] = std::min(3, block - first[k]);
        }
        for (int x = begin[0]; x < end[0]; ++x)
            for (int y = begin[1]; y < end[1]; ++y) {
                const double row = weight[0][x] * weight[1][y];
                const int offset = ((first[0] + x) * block + first[1] + y) * block + first[2];
                for (int z = begin[2]; z < end[2]; ++z) {
                    const double w = row * weight[2][z];
                    for (size_t k = 0; k < 3; ++k) to.moment[k][static_cast<size_t>(offset + z)] += w * moment[k];
                }
            }
    }

    Spheres spheres_;
    std::span<const uint8_t> codes_;
    FloatMargin margin_;
    double voxel_;
    std::vector<Filling> fillings_; ///< of the large spheres, ascending
};

std::unique_ptr<Leaf> make_leaf(const SphereBins::Voxel& at, const std::array<double, Leaf::SIZE>& values,
                                double factor)
{
    const auto first = [&](size_t k) { return static_cast<int>(at[k] * block); };
    auto leaf = std::make_unique<Leaf>(openvdb::Coord(first(0), first(1), first(2)), 0.0f, false);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i)
        if (const auto value = static_cast<float>(values[i] * factor); value > 0) leaf->setValueOn(i, value);
    return leaf;
}

/// Turns a block's sums into leaves, and resets the sums.
BlockLeaves to_leaves(const SphereBins::Voxel& at, double voxel, std::vector<TypeSums>& sums)
{
    const double factor[3] = {1 / voxel, 1, voxel};
    BlockLeaves leaves;
    std::array<double, Leaf::SIZE> fraction{};
    for (size_t type = 0; type < sums.size(); ++type) {
        TypeSums& from = sums[type];
        if (!from.used) continue;
        BlockLeaves::Type& to = leaves.types.emplace_back();
        to.type = type;
        for (size_t k = 0; k < 3; ++k) to.moment[k] = make_leaf(at, from.moment[k], factor[k]);
        for (size_t i = 0; i < Leaf::SIZE; ++i) fraction[i] += 4 * pi / 3 * from.moment[1][i];
        from = TypeSums();
    }
    leaves.pack_rate = make_leaf(at, fraction, 1);
    return leaves;
}

openvdb::FloatGrid::Ptr make_grid(const char* name)
{
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName(name);
    return grid;
}

/// The type codes of the spheres with radius above 0, ascending. place: set to each code's index in the result, or -1.
std::vector<uint8_t> codes_in_use(Spheres spheres, std::span<const uint8_t> type_codes, uint32_t type_count,
                                  std::vector<int>& place)
{
    std::vector<int> used(256, 0);
    for (size_t i = 0; i < spheres.size(); ++i) {
        const auto& s = spheres[i];
        if (type_codes[i] >= type_count)
            throw InputError("grain fields", fmt::format("type {} of grain {}", type_codes[i], i),
                             fmt::format("below {}", type_count));
        if (!std::isfinite(s.x) || !std::isfinite(s.y) || !std::isfinite(s.z) || !std::isfinite(s.r))
            throw InputError("grain fields",
                             fmt::format("sphere {} at ({}, {}, {}) of radius {}", i, s.x, s.y, s.z, s.r),
                             "finite numbers");
        if (s.r > 0) used[type_codes[i]] = 1;
    }
    std::vector<uint8_t> codes;
    place.assign(256, -1);
    for (size_t code = 0; code < used.size(); ++code) {
        if (!used[code]) continue;
        place[code] = static_cast<int>(codes.size());
        codes.push_back(static_cast<uint8_t>(code));
    }
    return codes;
}

double total(const openvdb::FloatGrid& grid)
{
    double sum = 0;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const float* values = leaf->buffer().data();
        for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) sum += values[i];
    }
    return sum;
}

/// index: in voxels.
double value_at(const openvdb::FloatGrid& grid, const V3d& index)
{
    // The field is 0 outside the range of voxel coordinates.
    for (int k = 0; k < 3; ++k)
        if (!(std::abs(index[k]) < 0x1p30)) return 0;
    return openvdb::tools::BoxSampler::sample(grid.tree(), openvdb::Vec3d(index.x, index.y, index.z));
}

} // namespace

GrainFields make_grain_fields(Spheres spheres, std::span<const uint8_t> type_codes, uint32_t type_count,
                              const GrainFieldOptions& options, const Progress& progress)
{
    if (type_codes.size() != spheres.size())
        throw InputError("grain fields", fmt::format("{} type codes", type_codes.size()),
                         fmt::format("one for each of {} spheres", spheres.size()));
    const double asked = options.voxel != 0 ? options.voxel : options.voxel_radii;
    if (!(asked > 0) || !std::isfinite(asked))
        throw InputError("grain fields", fmt::format("a voxel of {}", asked), "a positive number");

    openvdb::initialize();
    auto grids = std::make_unique<GrainFields::Grids>();
    std::vector<int> place;
    grids->codes = codes_in_use(spheres, type_codes, type_count, place);
    const double voxel =
        options.voxel != 0 ? options.voxel : options.voxel_radii * volume_weighted_radius(spheres, options.margin);
    if (!grids->codes.empty()) grids->voxel = voxel;
    for (size_t type = 0; type < grids->codes.size(); ++type)
        grids->types.push_back({make_grid("m2"), make_grid("m3"), make_grid("m4")});
    grids->pack_rate = make_grid("pack_rate");
    if (grids->codes.empty()) return GrainFields(std::move(grids));

    const Spreader spreader(spheres, type_codes, options.margin, voxel);
    const SphereBins bins(
        static_cast<uint32_t>(spheres.size()), block,
        [&](uint32_t i, SphereBins::Voxel& first, SphereBins::Voxel& last) { return spreader.range(i, first, last); });
    if (progress.cancelled()) throw Cancelled();

    std::vector<BlockLeaves> leaves(bins.bins().size());
    tbb::enumerable_thread_specific<std::vector<TypeSums>> workspaces(
        [&] { return std::vector<TypeSums>(grids->codes.size()); });
    std::atomic<uint64_t> done{0};
    tbb::parallel_for(size_t{0}, leaves.size(), [&](size_t i) {
        if (progress.cancelled()) return;
        const SphereBins::Bin& bin = bins.bins()[i];
        std::vector<TypeSums>& sums = workspaces.local();
        spreader.spread(bin, place, sums);
        leaves[i] = to_leaves(bin.block, voxel, sums);
        if (const uint64_t n = ++done; n % 1024 == 0)
            progress.update("grain fields", static_cast<double>(n) / static_cast<double>(leaves.size()));
    });
    if (progress.cancelled()) throw Cancelled();

    for (BlockLeaves& b : leaves) {
        for (BlockLeaves::Type& t : b.types) {
            GrainFields::Grids::Type& to = grids->types[t.type];
            for (size_t k = 0; k < 3; ++k)
                (k == 0 ? to.m2 : k == 1 ? to.m3 : to.m4)->tree().addLeaf(t.moment[k].release());
        }
        grids->pack_rate->tree().addLeaf(b.pack_rate.release());
    }
    progress.update("grain fields", 1);
    return GrainFields(std::move(grids));
}

GrainFields::GrainFields(std::unique_ptr<Grids> grids) : grids_(std::move(grids)) {}
GrainFields::~GrainFields() = default;
GrainFields::GrainFields(GrainFields&&) noexcept = default;
GrainFields& GrainFields::operator=(GrainFields&&) noexcept = default;

double GrainFields::voxel() const { return grids_->voxel; }
std::span<const uint8_t> GrainFields::types() const { return grids_->codes; }

MomentDensity GrainFields::moments(uint8_t type, const V3d& place) const
{
    const auto found = std::lower_bound(grids_->codes.begin(), grids_->codes.end(), type);
    if (found == grids_->codes.end() || *found != type) return {};
    const Grids::Type& t = grids_->types[static_cast<size_t>(found - grids_->codes.begin())];
    const V3d index = place / grids_->voxel;
    return {value_at(*t.m2, index), value_at(*t.m3, index), value_at(*t.m4, index)};
}

double GrainFields::pack_rate(const V3d& place) const
{
    return grids_->voxel > 0 ? value_at(*grids_->pack_rate, place / grids_->voxel) : 0;
}

MomentDensity GrainFields::totals(uint8_t type) const
{
    const auto found = std::lower_bound(grids_->codes.begin(), grids_->codes.end(), type);
    if (found == grids_->codes.end() || *found != type) return {};
    const Grids::Type& t = grids_->types[static_cast<size_t>(found - grids_->codes.begin())];
    const double volume = grids_->voxel * grids_->voxel * grids_->voxel;
    return {total(*t.m2) * volume, total(*t.m3) * volume, total(*t.m4) * volume};
}

double GrainFields::sphere_volume() const
{
    return total(*grids_->pack_rate) * grids_->voxel * grids_->voxel * grids_->voxel;
}
uint64_t GrainFields::voxels() const { return grids_->pack_rate->activeVoxelCount(); }

uint64_t GrainFields::bytes() const
{
    uint64_t sum = grids_->pack_rate->memUsage();
    for (const Grids::Type& t : grids_->types) sum += t.m2->memUsage() + t.m3->memUsage() + t.m4->memUsage();
    return sum;
}

} // namespace scree
