#include "tests/builders/tile_beds.h"

#include "mixtures/single_mixture.h"
#include "packing/tiles/tile_generator.h"
#include "tests/builders/shapes.h"

#include <map>

namespace scree {

std::shared_ptr<const PackingTile> sphere_tile(double fraction, uint64_t spheres)
{
    static std::map<std::pair<double, uint64_t>, std::shared_ptr<const PackingTile>> tiles;
    auto& tile = tiles[{fraction, spheres}];
    if (!tile) {
        TileOptions options;
        options.fraction = fraction;
        options.variants = 2;
        tile = std::make_shared<const PackingTile>(make_tile(std::vector<double>(spheres, 1.0), options, {}).tile);
    }
    return tile;
}

TileBed::TileBed(std::shared_ptr<const PackingTile> tile, double mean_radius, GrainType type, double half) : half_(half)
{
    TriangleMesh box = cube();
    for (V3d& p : box.positions) p *= half;
    const auto fill = std::make_shared<const ProceduralFill>(std::make_shared<const Domain>(box, "cube"),
                                                             std::move(tile), FillOptions{mean_radius, 0});
    world_.types.push_back(std::move(type));
    world_.fill = std::make_shared<GrainFill>(fill, std::make_shared<SingleMixture>(0), world_.space);
    world_.domain = fill->domain().bounds();
    tracer_ = std::make_unique<Tracer>(std::make_shared<EmbreeDevice>(), world_);
}

} // namespace scree
