#include "render/build/grain_medium.h"

#include "base/error.h"
#include "base/hash.h"
#include "render/equivalent/core_region.h"
#include "render/equivalent/grain_field_grids.h"
#include "render/equivalent/walk_bed.h"
#include "render/media/grid_medium_build.h"
#include "render/media/homogeneous_medium.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace scree {

namespace {

constexpr uint64_t sampled = 20000; // grains: an error of 0.7 % in a type's share

/// The medium for mixtures and pack rates near those of the whole packing: the formula, corrected by the factors that
/// the walk in the whole packing found.
class LocalMedia {
public:
    LocalMedia(const GrainMedium& whole, const MomentTable& table) : whole_(whole), table_(table)
    {
        const ContinuousEquivalent formula =
            continuous_equivalent(whole.moments, whole.medium.form == EquivalentForm::plain ? EquivalentForm::plain
                                                                                            : EquivalentForm::formula);
        diffusivity_ = whole.medium.diffusivity / formula.diffusivity;
        transport_ = whole.medium.transport_length / formula.transport_length;
        for (int c = 0; c < 3; ++c)
            lost_[c] = formula.albedo[c] < 1 ? (1 - whole.medium.albedo[c]) / (1 - formula.albedo[c]) : 1;
    }
    const MomentTable& table() const { return table_; }

    struct Local {
        float sigma_t = 0, g = 0;
        V3f albedo{1};
    };
    /// The medium for these shares; no scattering without grains.
    Local at(const std::vector<GrainShare>& shares, double pack_rate) const
    {
        if (shares.empty() || !(pack_rate > 0)) return {};
        const MixtureMoments moments = mixture_moments(shares, std::min(pack_rate, densest));
        if (whole_.medium.form == EquivalentForm::plain)
            return {static_cast<float>(1 / moments.flight), static_cast<float>(moments.g), V3f(moments.albedo)};
        // Grains far apart do not influence each other: there the formula needs no correction.
        const double together = std::min(1.0, pack_rate / whole_.pack_rate);
        const auto corrected = [together](double factor) { return 1 + together * (factor - 1); };
        const double d = moments.diffusivity() * corrected(diffusivity_),
                     l = moments.transport_length() * corrected(transport_);
        const double g = std::clamp(1 - d / (l * l), -0.95, 0.9999);
        V3d albedo;
        for (int c = 0; c < 3; ++c) albedo[c] = std::clamp(1 - (1 - moments.albedo[c]) * corrected(lost_[c]), 0.0, 1.0);
        return {static_cast<float>(1 / (l * (1 - g))), static_cast<float>(g), V3f(albedo)};
    }

private:
    static constexpr double densest = 0.9; // overlapping grains can exceed a pack rate of 1
    const GrainMedium& whole_;
    const MomentTable& table_;
    double diffusivity_ = 1, transport_ = 1;
    V3d lost_{1};
};

/// The grids of a medium.
struct Grids {
    openvdb::FloatGrid::Ptr sigma_t = openvdb::FloatGrid::create(0), g = openvdb::FloatGrid::create(0);
    openvdb::Vec3SGrid::Ptr albedo = openvdb::Vec3SGrid::create(openvdb::Vec3s(1));
    Imath::M44d to_render;

    std::shared_ptr<const GridMedium> make(const Progress& progress) const
    {
        MediumGrids grids{sigma_t, albedo, g, to_render, "the medium of the grains"};
        return std::make_shared<GridMedium>(make_grid_medium(grids, {}, {}, progress));
    }
};

/// Sets each of the voxels to at(voxel).
template <class At>
void fill_voxels(Grids& grids, const std::vector<openvdb::Coord>& voxels, const At& at, const Progress& progress)
{
    std::vector<LocalMedia::Local> local(voxels.size());
    tbb::parallel_for(size_t{0}, voxels.size(), [&](size_t i) {
        if (!progress.cancelled()) local[i] = at(voxels[i]);
    });
    if (progress.cancelled()) throw Cancelled();
    auto sigma_t = grids.sigma_t->getAccessor(), g = grids.g->getAccessor();
    auto albedo = grids.albedo->getAccessor();
    for (size_t i = 0; i < voxels.size(); ++i) {
        sigma_t.setValue(voxels[i], local[i].sigma_t);
        g.setValue(voxels[i], local[i].g);
        albedo.setValue(voxels[i], {local[i].albedo.x, local[i].albedo.y, local[i].albedo.z});
    }
}

std::shared_ptr<const GridMedium> medium_of_list(const World& world, const LocalMedia& media, const Progress& progress)
{
    const GrainStore& grains = world.grains;
    const GrainFieldOptions options{.margin = grains.margin};
    const GrainFields fields = make_grain_fields({grains.spheres.data(), grains.size()}, grains.type_codes,
                                                 static_cast<uint32_t>(world.types.size()), options, progress);
    const GrainFields::Grids& known = fields.grids();
    std::vector<openvdb::Coord> voxels;
    for (auto it = known.pack_rate->cbeginValueOn(); it; ++it) voxels.push_back(it.getCoord());
    Grids grids;
    grids.to_render.setScale(known.voxel);
    fill_voxels(
        grids, voxels,
        [&](const openvdb::Coord& at) {
            std::vector<GrainShare> shares;
            for (size_t i = 0; i < known.types.size(); ++i) {
                const auto& type = known.types[i];
                media.table().add_shares(known.codes[i], type.m2->tree().getValue(at), type.m3->tree().getValue(at),
                                         type.m4->tree().getValue(at), shares);
            }
            // At the rim the last grains are spread over voxels that are partly outside. So the pack rate is the mean
            // over the neighbours, weighted by their own pack rates.
            double rate = 0, square = 0;
            for (int i = -1; i <= 1; ++i) {
                for (int j = -1; j <= 1; ++j) {
                    for (int k = -1; k <= 1; ++k) {
                        const double f = known.pack_rate->tree().getValue(at.offsetBy(i, j, k));
                        rate += f;
                        square += f * f;
                    }
                }
            }
            return media.at(shares, rate > 0 ? square / rate : 0);
        },
        progress);
    return grids.make(progress);
}

std::shared_ptr<const GridMedium> medium_of_fill(const World& world, const RegionSurface& region,
                                                 const LocalMedia& media, const Progress& progress)
{
    constexpr int longest = 96; // voxels along the region
    constexpr uint64_t drawn = 64; // spheres per voxel: a share of one half is known to 6 %
    Imath::Box3d box;
    for (const V3f& p : region.positions) box.extendBy(V3d(p));
    const V3d size = box.size();
    const GrainFill& fill = *world.fill;
    const double voxel = std::max({size.x, size.y, size.z}) / longest;
    std::vector<openvdb::Coord> voxels;
    for (int i = -1; (i - 1) * voxel <= size.x; ++i) {
        for (int j = -1; (j - 1) * voxel <= size.y; ++j) {
            for (int k = -1; (k - 1) * voxel <= size.z; ++k) voxels.emplace_back(i, j, k);
        }
    }
    Grids grids;
    grids.to_render.setScale(voxel);
    grids.to_render[3][0] = box.min.x;
    grids.to_render[3][1] = box.min.y;
    grids.to_render[3][2] = box.min.z;
    const uint64_t rows = fill.fill().tile().rows();
    fill_voxels(
        grids, voxels,
        [&](const openvdb::Coord& at) {
            struct Sums {
                double m2 = 0, m3 = 0, m4 = 0;
            };
            std::vector<Sums> sums(world.types.size());
            const uint64_t key =
                hash_index(static_cast<uint64_t>(static_cast<uint32_t>(at.x())) << 32 | static_cast<uint32_t>(at.y()),
                           static_cast<uint64_t>(static_cast<uint32_t>(at.z())));
            for (uint64_t n = 0; n < drawn; ++n) {
                const uint64_t random = hash_index(n, key);
                const uint64_t cell = random % fill.fill().cell_count(), row = mix64(random) % rows;
                const auto offset = [&](uint64_t stream) {
                    return static_cast<double>(hash_index(n, key, stream) >> 11) * 0x1p-53 - 0.5;
                };
                const V3d place = box.min + voxel * V3d(at.x() + offset(1), at.y() + offset(2), at.z() + offset(3));
                const uint64_t id = fill.fill().id(cell, row);
                const float radius = fill.fill().radius(row);
                Sums& sum = sums[fill.type(id, {world.space.world_point(place), radius})];
                const double r = world.space.length(radius), r2 = r * r;
                sum.m2 += r2;
                sum.m3 += r2 * r;
                sum.m4 += r2 * r2;
            }
            std::vector<GrainShare> shares;
            for (size_t t = 0; t < sums.size(); ++t)
                media.table().add_shares(static_cast<uint8_t>(t), sums[t].m2, sums[t].m3, sums[t].m4, shares);
            return media.at(shares, fill.fill().tile().fraction());
        },
        progress);
    return grids.make(progress);
}

bool is_patterned(const World& world, const PackingSample& sample)
{
    // Compares the types of an id with and without a sphere at another place: a mixture that only depends on ids gives
    // the same type.
    const GrainFill& fill = *world.fill;
    for (size_t i = 0; i < sample.grains.size(); i += 16) {
        const uint64_t cell = hash_index(i, 0) % fill.fill().cell_count(),
                       other = hash_index(i, 1) % fill.fill().cell_count();
        const uint64_t id = fill.fill().id(cell, sample.grains[i].row);
        const ProceduralFill::Sphere sphere = fill.fill().sphere(fill.fill().id(other, sample.grains[i].row));
        if (fill.type(id) != fill.type(id, sphere)) return true;
    }
    return false;
}

/// sample: at least one grain.
GrainMedium make_grain_medium(const World& world, PackingSample sample, EquivalentForm form, const Progress& progress)
{
    GrainMedium result;
    result.sample = std::move(sample);
    const MomentTable table(world.types, result.sample);
    constexpr double loosest = 1e-6, densest = 0.9; // for heaps of a few grains, and of overlapping grains
    result.pack_rate = result.sample.pack_rate = std::clamp(result.sample.pack_rate, loosest, densest);
    if (needs_walk(form)) {
        const BedWalk walked = walk_like(world, result.sample, progress);
        result.walk = walked.walk;
        result.pack_rate = walked.pack_rate;
    }
    result.moments = mixture_moments(shares_of(result.sample, table), result.pack_rate);
    result.medium = continuous_equivalent(result.moments, form, result.walk ? &*result.walk : nullptr);
    return result;
}

std::optional<RegionSurface> surface_below(const World& world, double depth, const Progress& progress)
{
    if (!world.fill) return core_of_spheres({world.grains.spheres.data(), world.grains.size()}, depth, progress);
    const TriangleMesh& mesh = world.fill->fill().domain().mesh();
    std::vector<V3f> positions;
    for (const V3d& p : mesh.positions) positions.emplace_back(world.space.point(p));
    return inset_of_mesh(positions, mesh.triangles, depth, progress);
}

/// The volume of grains that a medium replaces.
struct Core {
    double below = 0; ///< depth below every face
    std::optional<RegionSurface> surface;

    bool is_empty() const { return !surface || surface->triangles.empty(); }
};

/// Least depth of any medium, whatever its mean free path.
double least_depth(const PackingSample& sample, const GrainDepth& depth)
{
    return depth.all ? sample.volume_weighted_radius() : depth.radii * sample.mean_radius();
}

constexpr const char* part = "medium of the grains";

void take_all_grains(World& world)
{
    world.replaced_grains = world.grain_count();
    world.grains = {};
    world.fill = nullptr;
}

void report_no_core(double below, const PackingSample& sample, const GrainDepth& depth, double seconds,
                    std::vector<PartReport>& parts, std::vector<std::string>& remarks)
{
    parts.push_back({part, false,
                     depth.all ? "no grain lies deeper than one radius"
                               : fmt::format("no place is {:.3g} mean radii deep", below / sample.mean_radius()),
                     seconds});
    if (depth.all)
        remarks.push_back("no place among the grains is deeper than one radius: the picture shows no grains");
}

/// core: at the least depth of the medium. Returns the depth from which the medium replaces grains, in mean radii.
std::optional<double> replace_grains(const GrainMedium& medium, const GrainDepth& depth, Core core, World& world,
                                     std::vector<PartReport>& parts, std::vector<std::string>& remarks,
                                     const Progress& progress)
{
    const Stopwatch watch;
    const double radius = medium.sample.mean_radius(),
                 below = depth.all ? core.below : std::max(core.below, depth.flights / medium.medium.sigma_t);
    if (below > core.below) core = {below, surface_below(world, below, progress)};
    std::optional<RegionSurface>& surface = core.surface;
    const bool is_made = !core.is_empty();
    if (is_made) {
        const MomentTable table(world.types, medium.sample);
        const LocalMedia media(medium, table);
        MediumRegion region;
        region.name = part;
        region.instead_of_grains = true;
        std::string how = fmt::format("from {:.3g} mean radii below every face, inside {} triangles, ", below / radius,
                                      surface->triangles.size());
        uint64_t bytes =
            surface->triangles.size() * sizeof(surface->triangles[0]) + surface->positions.size() * sizeof(V3f);
        if (!world.fill)
            region.medium = medium_of_list(world, media, progress);
        else if (is_patterned(world, medium.sample))
            region.medium = medium_of_fill(world, *surface, media, progress);
        else
            region.medium = std::make_shared<HomogeneousMedium>(V3d(medium.medium.sigma_t),
                                                                Weight(medium.medium.albedo), medium.medium.g);
        bytes += region.medium->bytes();
        region.positions = std::move(surface->positions);
        region.triangles = std::move(surface->triangles);
        world.regions.push_back(std::move(region));
        parts.push_back({part, true,
                         how + (world.regions.back().medium->uniform() ? "the same everywhere" : "as the grains vary"),
                         watch.seconds(), bytes});
        if (surface->coarsened)
            remarks.push_back(
                "the surface of the medium that replaces the grains is coarse: a finer one would need too many voxels");
        if (!medium.medium.doubt.empty()) remarks.push_back("the medium of the grains: " + medium.medium.doubt);
    } else {
        report_no_core(below, medium.sample, depth, watch.seconds(), parts, remarks);
    }
    if (depth.all) take_all_grains(world);
    return is_made ? std::optional(below / radius) : std::nullopt;
}

} // namespace

std::optional<GrainMedium> make_grain_medium(const World& world, EquivalentForm form, const Progress& progress)
{
    PackingSample sample = sample_packing(world, sampled, progress);
    if (sample.grains.empty()) return std::nullopt;
    return make_grain_medium(world, std::move(sample), form, progress);
}

std::optional<double> replace_grains(const GrainMedium& medium, const GrainDepth& depth, World& world,
                                     std::vector<PartReport>& parts, std::vector<std::string>& remarks,
                                     const Progress& progress)
{
    const double below = least_depth(medium.sample, depth);
    return replace_grains(medium, depth, Core{below, surface_below(world, below, progress)}, world, parts, remarks,
                          progress);
}

std::optional<double> replace_grains(EquivalentForm form, const GrainDepth& depth, World& world,
                                     std::vector<PartReport>& parts, std::vector<std::string>& remarks,
                                     const Progress& progress)
{
    const char* walk = "walk in the packing";
    const Stopwatch core_watch;
    PackingSample sample = sample_packing(world, sampled, progress);
    if (sample.grains.empty()) return std::nullopt; // the world has no grains
    const double below = least_depth(sample, depth);
    Core core{below, surface_below(world, below, progress)};
    if (core.is_empty()) {
        parts.push_back({walk, false, "no medium is made from it"});
        report_no_core(below, sample, depth, core_watch.seconds(), parts, remarks);
        if (depth.all) take_all_grains(world);
        return std::nullopt;
    }
    const Stopwatch watch;
    const GrainMedium medium = make_grain_medium(world, std::move(sample), form, progress);
    if (medium.walk) {
        const Measured& length = medium.walk->transport_length;
        parts.push_back({walk, true,
                         fmt::format("{} scatterings, transport length to {:.2g} %", medium.walk->scatterings,
                                     100 * length.error / length.value),
                         watch.seconds()});
    } else {
        parts.push_back({walk, false, "the form of the medium needs none"});
    }
    return replace_grains(medium, depth, std::move(core), world, parts, remarks, progress);
}

} // namespace scree
