#include "packing/tiles/tile_generator.h"

#include "base/error.h"
#include "packing/tiles/tile_jamming.h"
#include "packing/tiles/tile_random.h"
#include "packing/tiles/tile_sizes.h"
#include "packing/tiles/tile_variants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>

namespace scree {

namespace {

constexpr uint64_t place_stream = 0x706c616365;
constexpr uint64_t tries = 3;
// Compression goes to this multiple of the random close packing fraction: spheres that are compressed so far find
// denser packings on decompression than spheres that jam at first contact (fraction 0.645 against 0.639).
constexpr double overfull = 1.25;
const std::string command = "scree pack tile";

/// Combines the progress of the first packing and of the variants, which report from several threads.
class TileProgress {
public:
    TileProgress(uint32_t variants, const Progress& progress) : parts_(variants, 0), progress_(progress) {}
    void update(uint32_t variant, double part)
    {
        const std::lock_guard lock(mutex_);
        parts_[variant] = std::max(parts_[variant], part);
        double sum = 0;
        for (const double p : parts_) sum += p;
        progress_.update("packing spheres", sum / static_cast<double>(parts_.size()));
    }

private:
    std::mutex mutex_;
    std::vector<double> parts_;
    const Progress& progress_;
};

void check_options(uint64_t count, const TileOptions& options)
{
    if (count == 0) throw InputError(command, "no spheres", "1 sphere or more", "--spheres 10000");
    for (int axis = 0; axis < 3; ++axis)
        if (!(options.size[axis] > 0) || !std::isfinite(options.size[axis]))
            throw InputError(command,
                             fmt::format("a cuboid of {} x {} x {}", options.size.x, options.size.y, options.size.z),
                             "edges above 0", "--size 1x1x1");
    if (options.fraction && !(*options.fraction > 0 && *options.fraction < 1))
        throw InputError(command, fmt::format("--fraction {}", *options.fraction), "above 0 and below 1, or max",
                         "equal spheres reach about 0.64 if disordered");
    if (options.variants == 0) throw InputError(command, "--variants 0", "1 variant or more");
}

/// Spheres must be clearly smaller than the cuboid, so that none touches its own image and no two touch twice.
void check_room(const TileSpheres& spheres)
{
    const double largest = 2 * spheres.largest_radius(),
                 shortest = std::min({spheres.size.x, spheres.size.y, spheres.size.z});
    if (1.5 * largest < shortest) return;
    throw InputError(
        command,
        fmt::format("a sphere of diameter {:.4g} in a cuboid whose shortest edge is {:.4g}", largest, shortest),
        "a shortest edge of at least 1.5 times the largest diameter",
        "more spheres, a narrower range of radii, or edges that differ less");
}

/// Packs variant 0. Throws InputError if it jams below the fraction.
void pack_first(TileSpheres& spheres, const TileOptions& options, bool fluid, MadeTile& made, const TileStep& step,
                const Progress& progress)
{
    const double densest = overfull * random_close_packing(spheres.radius);
    double best = 0;
    for (uint64_t attempt = 0; attempt < tries; ++attempt) {
        TileRandom random(hash_index(attempt, options.seed), place_stream);
        for (Imath::V3d& p : spheres.place) p = wrapped_into(random.cube() * spheres.size, spheres.size);
        double scale = 0;
        if (options.fraction) scale = settle_spheres(spheres, 1, step, progress);
        if (scale < 1) scale = jam_spheres(spheres, densest, 1, step, progress);
        if (!options.fraction) {
            for (double& r : spheres.radius) r *= scale;
            made.jammed_fraction = spheres.fraction();
            return;
        }
        if (scale >= 1) {
            if (fluid) made.fluid_run = equilibrate_spheres(spheres, 0, options.sweeps, options.seed, step, progress);
            return;
        }
        best = std::max(best, scale);
    }
    throw InputError(command, fmt::format("--fraction {}", *options.fraction),
                     fmt::format("a fraction these spheres reach: at most {:.4f} in {} tries",
                                 spheres.fraction() * std::pow(best, 3), tries),
                     "--fraction max packs them until they jam");
}

/// The radius as files store it, rounded down, so that rounding creates no overlap.
float rounded_down(double radius)
{
    const auto r = static_cast<float>(radius);
    return r > radius ? std::nextafter(r, 0.0f) : r;
}

/// Makes the tile from a periodic packing: orders rows, makes variants, sets radii. types: by row of the packing, or
/// empty. goal: a sufficient scale of the radii; nothing: as large as possible. may_shrink: whether a smaller scale
/// than the goal is accepted.
void finish(TileSpheres spheres, const std::vector<int32_t>& types, std::optional<double> goal, bool may_shrink,
            const TileOptions& options, MadeTile& made, TileProgress& shown, const Progress& progress)
{
    std::vector<uint64_t> order;
    const uint64_t shared = order_by_faces(spheres, order);
    TileVariants variants{{spheres.place}, 1};
    if (options.variants > 1) {
        if (shared == spheres.count())
            throw InputError(command,
                             fmt::format("{} variants of {} spheres, none of which is wholly inside the cuboid",
                                         options.variants, spheres.count()),
                             "spheres that can differ between the variants", "more spheres, or --variants 1");
        if (made.fluid) {
            variants = equilibrate_variants(
                spheres, shared, options.variants, options.sweeps, options.seed,
                [&](uint32_t v, double part) { shown.update(v, part); }, progress);
        } else {
            variants = pack_variants(
                spheres, shared, options.variants, goal, options.seed,
                [&](double part) {
                    for (uint32_t v = 1; v < options.variants; ++v) shown.update(v, part);
                },
                progress);
        }
        if (variants.scale < 1 && !may_shrink)
            throw InputError(command,
                             fmt::format("{} variants at fraction {:.6g}", options.variants, spheres.fraction()),
                             fmt::format("a fraction that variants with the same boundary spheres reach: {:.4f}",
                                         spheres.fraction() * std::pow(variants.scale, 3)),
                             "a lower --fraction, --fraction max, or --variants 1");
    }
    PackingTile& tile = made.tile;
    tile.size = spheres.size;
    for (const double r : spheres.radius) tile.radius.push_back(rounded_down(r * variants.scale));
    for (const uint64_t row : order) tile.type.push_back(types.empty() ? 1 : types[row]);
    tile.shared = static_cast<uint32_t>(shared);
    tile.variants = std::move(variants.places);
    made.radius_scale *= variants.scale;
}

} // namespace

MadeTile make_tile(std::span<const double> radii, const TileOptions& options, const Progress& progress)
{
    check_options(radii.size(), options);
    TileSpheres spheres;
    spheres.size = options.size;
    spheres.radius.assign(radii.begin(), radii.end());
    spheres.place.resize(radii.size());
    const double wanted = options.fraction.value_or(random_close_packing(radii));
    const double scale = cube_root(wanted / spheres.fraction());
    for (double& r : spheres.radius) r *= scale;
    check_room(spheres);

    MadeTile made;
    made.fluid =
        options.fraction && (options.sweeps ? *options.sweeps > 0 : *options.fraction <= TileOptions::densest_fluid);
    TileProgress shown(options.variants, progress);
    const double before = spheres.radius[0];
    pack_first(
        spheres, options, made.fluid, made, [&](double part) { shown.update(0, part); }, progress);
    shown.update(0, 1);
    made.radius_scale = scale * spheres.radius[0] / before;
    finish(std::move(spheres), {}, options.fraction ? std::optional<double>(1) : std::nullopt, !options.fraction,
           options, made, shown, progress);
    return made;
}

MadeTile tile_from_frame(const ParticleFrame& frame, const std::string& place, const TileOptions& options,
                         const Progress& progress)
{
    const std::string hint = "--region x0,x1,y0,y1,z0,z1 cuts a cuboid out of any frame and makes it periodic";
    if (frame.size() == 0) throw InputError(place, "a frame without particles", "spheres");
    if (!frame.box) throw InputError(place, "no simulation box", "a periodic box", hint);
    const SimulationBox& box = *frame.box;
    TileSpheres spheres;
    for (int axis = 0; axis < 3; ++axis) {
        const Imath::V3d& edge = box.edges[static_cast<size_t>(axis)];
        if (!box.periodic[static_cast<size_t>(axis)])
            throw InputError(place, fmt::format("a box that is not periodic along {}", "xyz"[axis]),
                             "a box that is periodic along x, y and z", hint);
        for (int other = 0; other < 3; ++other)
            if (other != axis && edge[other] != 0)
                throw InputError(place, "a triclinic box", "a cuboid: edges along x, y and z", hint);
        if (!(edge[axis] > 0) || !std::isfinite(edge[axis]))
            throw InputError(place, fmt::format("a box of length {} along {}", edge[axis], "xyz"[axis]),
                             "a box with a volume");
        spheres.size[axis] = edge[axis];
    }
    for (size_t i = 0; i < frame.size(); ++i) {
        if (!(frame.radius[i] > 0))
            throw InputError(place, fmt::format("radius {} of particle {}", frame.radius[i], frame.id[i]),
                             "radii above 0", "--radius gives radii where a dump has none");
        spheres.radius.push_back(frame.radius[i]);
        spheres.place.push_back(wrapped_into(frame.position[i] - box.lo, spheres.size));
    }
    check_room(spheres);
    if (!(spheres.fraction() < 1))
        throw InputError(place, fmt::format("spheres of {:.4g} times the volume of the box", spheres.fraction()),
                         "spheres of less volume than the box", "are the radii right?");

    MadeTile made;
    TileProgress shown(options.variants, progress);
    const std::vector<Imath::V3d> before = spheres.place;
    made.radius_scale = settle_spheres(
        spheres, 1, [&](double part) { shown.update(0, part); }, progress);
    shown.update(0, 1);
    const bool jammed = made.radius_scale < 1;
    for (double& r : spheres.radius) r *= made.radius_scale;
    if (jammed) made.jammed_fraction = spheres.fraction();
    for (size_t i = 0; i < before.size(); ++i) {
        Imath::V3d d = spheres.place[i] - before[i];
        for (int axis = 0; axis < 3; ++axis) d[axis] -= std::round(d[axis] / spheres.size[axis]) * spheres.size[axis];
        const double shift = d.length() / spheres.mean_radius();
        made.mean_shift += shift / static_cast<double>(before.size());
        made.largest_shift = std::max(made.largest_shift, shift);
    }
    made.fluid = options.sweeps ? *options.sweeps > 0 : spheres.fraction() <= TileOptions::densest_fluid;
    finish(std::move(spheres), frame.type, 1, true, options, made, shown, progress);
    return made;
}

ParticleFrame cut_cuboid(const ParticleFrame& frame, const Imath::V3d& lo, const Imath::V3d& hi,
                         const std::string& place)
{
    ParticleFrame cut;
    SimulationBox box;
    box.lo = lo;
    box.periodic = {true, true, true};
    for (int axis = 0; axis < 3; ++axis) {
        if (!(lo[axis] < hi[axis]))
            throw InputError("--region", fmt::format("{} to {} along {}", lo[axis], hi[axis], "xyz"[axis]),
                             "x0,x1,y0,y1,z0,z1, each from low to high");
        box.edges[static_cast<size_t>(axis)][axis] = hi[axis] - lo[axis];
    }
    cut.box = box;
    cut.has_ids = frame.has_ids;
    for (size_t i = 0; i < frame.size(); ++i) {
        const Imath::V3d& p = frame.position[i];
        if (!(p.x >= lo.x && p.x < hi.x && p.y >= lo.y && p.y < hi.y && p.z >= lo.z && p.z < hi.z)) continue;
        cut.position.push_back(p);
        cut.radius.push_back(frame.radius[i]);
        cut.type.push_back(frame.type[i]);
        cut.id.push_back(frame.id[i]);
    }
    if (cut.size() == 0) throw InputError(place, "no particle in the region", "spheres with centres in it");
    cut.origin = middle_of_bounds(cut.position);
    return cut;
}

} // namespace scree
