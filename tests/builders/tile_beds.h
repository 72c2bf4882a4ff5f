#pragma once

#include "packing/tiles/packing_tile.h"
#include "render/trace/tracer.h"

#include <memory>

namespace scree {

/// A tile of `spheres` equal spheres, made once and kept; any fraction that tile_generator can make.
std::shared_ptr<const PackingTile> sphere_tile(double fraction, uint64_t spheres);

/// A cube from -half to half in all directions, filled from a tile with grains of one type, and the tracer over it;
/// lengths are render units. A larger cube costs no more.
class TileBed {
public:
    TileBed(std::shared_ptr<const PackingTile> tile, double mean_radius, GrainType type, double half);

    const World& world() const { return world_; }
    const Tracer& tracer() const { return *tracer_; }
    double half() const { return half_; }

private:
    double half_;
    World world_;
    std::unique_ptr<Tracer> tracer_;
};

} // namespace scree
