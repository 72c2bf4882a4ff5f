#pragma once

#include "render/integrators/path_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/statistics.h"

#include <memory>
#include <optional>

namespace scree {

/// A slab between z = 0 and z = -depth, far wider than light travels, under a white sky. shells: their form, or none.
std::unique_ptr<TestScene> slab(double depth, const V3d& sigma_t, const Color& albedo, double g,
                                std::optional<StfForm> shells = {});

/// The slab as a grid of equal voxels in its box, between z = depth / 2 and -depth / 2.
struct GridSlab {
    World world;
    std::unique_ptr<Tracer> tracer;

    /// sigma_t: per `unit`, which is a length.
    GridSlab(double depth, double sigma_t, float albedo, double g, double unit, std::optional<StfForm> shells = {});
};

struct ReflectedAndPassed {
    Estimate up[3], down[3]; ///< by channel
};

/// The radiance of rays that come down from `distance` to (0, 0, 0), by the side on which they leave. cosine: of
/// incidence; below 0: directions are distributed as in diffuse light.
ReflectedAndPassed shine(const World& world, const Tracer& tracer, double distance, uint32_t paths, double cosine,
                         uint64_t seed);
ReflectedAndPassed shine(const TestScene& scene, uint32_t paths, double cosine, uint64_t seed);

/// Mean radiance of rays from all around towards the middle of the scene.
Estimate from_all_around(const World& world, const Tracer& tracer, uint32_t count, double distance,
                         const PathOptions& options, uint64_t seed);

} // namespace scree
