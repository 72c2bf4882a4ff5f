#include "render/equivalent/walk_bed.h"

#include "base/error.h"
#include "base/hash.h"
#include "packing/tiles/tile_generator.h"

#include <numeric>

namespace scree {

namespace {

/// Chooses a type by the row of a tile: one of the types that the sample has in that row.
class RowMixture : public Mixture {
public:
    RowMixture(std::vector<std::vector<uint8_t>> types, uint8_t other) : types_(std::move(types)), other_(other) {}
    uint32_t type(uint64_t index, const V3f&) const override
    {
        const std::vector<uint8_t>& seen = types_[index % types_.size()];
        return seen.empty() ? other_ : seen[hash_index(index, 1) % seen.size()];
    }

private:
    std::vector<std::vector<uint8_t>> types_;
    uint8_t other_;
};

/// A tile of 1000 grains that represent the sample; a random packing needs no more. taken: set to these grains.
std::shared_ptr<const PackingTile> pack(const PackingSample& sample, std::vector<PackingSample::Grain>& taken,
                                        const Progress& progress)
{
    constexpr size_t most = 1000;
    std::vector<PackingSample::Grain> sorted = sample.grains;
    std::ranges::stable_sort(sorted, {}, &PackingSample::Grain::radius);
    std::vector<double> radii;
    for (size_t i = 0; i < most; ++i) { // equally spaced in order of size; a small sample repeats grains
        taken.push_back(sorted[(2 * i + 1) * sorted.size() / (2 * most)]);
        radii.push_back(taken.back().radius);
    }
    constexpr double densest = 0.62, looser = 0.95,
                     loosest = 0.5; // most size distributions can be packed to `densest`, all to `loosest`
    TileOptions options;
    options.variants = 1;
    for (double fraction = std::min(sample.pack_rate, densest);; fraction *= looser) {
        options.fraction = fraction;
        try {
            return std::make_shared<const PackingTile>(make_tile(radii, options, progress).tile);
        } catch (const InputError&) { // jammed
            if (fraction < loosest) throw;
        }
    }
}

double mean_of(const std::vector<PackingSample::Grain>& grains)
{
    double sum = 0;
    for (const PackingSample::Grain& grain : grains) sum += grain.radius;
    return sum / static_cast<double>(grains.size());
}

} // namespace

BedWalk walk_like(const World& world, const PackingSample& sample, const Progress& progress)
{
    std::vector<PackingSample::Grain> grains;
    std::shared_ptr<const PackingTile> tile;
    if (world.fill) {
        grains = sample.grains;
        tile = std::shared_ptr<const PackingTile>(world.fill, &world.fill->fill().tile());
    } else {
        tile = pack(sample, grains, progress);
        // Packing reorders the rows; grains and rows are matched by size.
        std::vector<uint64_t> rows(tile->rows());
        std::iota(rows.begin(), rows.end(), 0);
        std::ranges::stable_sort(rows, {}, [&](uint64_t row) { return tile->radius[row]; });
        std::ranges::stable_sort(grains, {}, &PackingSample::Grain::radius);
        for (size_t i = 0; i < grains.size(); ++i) grains[i].row = rows[i];
    }
    std::vector<std::vector<uint8_t>> types(tile->rows());
    for (const PackingSample::Grain& grain : grains) types[grain.row].push_back(grain.type);

    // The bed's unit of length is the mean radius, whatever the unit of the world.
    const double unit =
        world.fill ? world.fill->fill().tile().mean_radius() * world.fill->fill().scale() * world.space.length(1)
                   : mean_of(grains);
    // So large that no walk comes near the faces; a larger cube costs nothing extra.
    const double half = 2000 / std::min(sample.pack_rate, 1.0);
    World bed;
    bed.types = world.types;
    for (GrainType& type : bed.types) {
        type.material.absorption *= static_cast<float>(unit);
        type.exemplar = nullptr; // all grains are proxies
        if (!type.gsdf) type.gsdf = world.types[grains.front().type].gsdf; // a type without grains; any GSDF will do
    }
    const auto fill = std::make_shared<ProceduralFill>(
        std::make_shared<const Domain>(box_mesh(V3d(-half), V3d(half)), "a cube"), tile, FillOptions{1, 0});
    bed.fill = std::make_shared<GrainFill>(fill, std::make_shared<RowMixture>(std::move(types), grains.front().type),
                                           bed.space);
    bed.domain = fill->domain().bounds();
    const Tracer tracer(std::make_shared<EmbreeDevice>(), bed);
    PackingWalkOptions options;
    options.start_radius = 0.2 * half;
    options.safe_radius = 0.95 * half;
    PackingWalk walk = walk_packing(bed, tracer, options, progress);
    for (Measured* length : {&walk.void_flight, &walk.flight, &walk.transport_length, &walk.half_transport_length}) {
        length->value *= unit;
        length->error *= unit;
    }
    for (Measured* area : {&walk.diffusivity, &walk.half_diffusivity}) {
        area->value *= unit * unit;
        area->error *= unit * unit;
    }
    for (PackingDecay& decay : walk.decay) {
        for (Measured* rate : {&decay.kappa, &decay.check}) {
            rate->value /= unit;
            rate->error /= unit;
        }
    }
    return {walk, tile->fraction()};
}

} // namespace scree
