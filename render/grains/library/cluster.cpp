#include "render/grains/library/radial_surface.h"
#include "render/grains/library/shape_generator.h"
#include "render/grains/library/shape_random.h"

#include "base/noise.h"

namespace scree {

namespace {

/// A granule that bulges out of the lump: a cap of a sphere.
struct Granule {
    V3d direction;
    double radius2; ///< square of the sphere's radius
    double sunk; ///< depth of the sphere's centre below the surface
};

} // namespace

TriangleMesh make_cluster(const ShapeRequest& request)
{
    ShapeRandom random(request.seed, 0x636c75);
    NoiseOptions lumps;
    lumps.scale = V3d(request["lump_size"]);
    lumps.octaves = 2;
    lumps.seed = random.next();
    const FractalNoise lump(lumps);
    const double lumpiness = request["lumpiness"];
    const V3d axes(1, random.uniform(0.7, 0.95), random.uniform(0.6, 0.85));
    const auto core = [&](const V3d& d) {
        const double ellipsoid = 1 / V3d(d.x / axes.x, d.y / axes.y, d.z / axes.z).length();
        return ellipsoid * (1 + lumpiness * lump(ellipsoid * d));
    };

    std::vector<Granule> granules;
    const double size = request["granule_size"];
    while (granules.size() < static_cast<size_t>(request["granules"])) {
        const V3d d = random.direction();
        const double u = random.uniform(), radius = size * (0.35 + 0.65 * u * u); // starch: many small, few large
        granules.push_back({d, radius * radius, radius * random.uniform(0.15, 0.6)});
    }

    NoiseOptions fine;
    fine.scale = V3d(0.12);
    fine.octaves = 2;
    fine.seed = random.next();
    const FractalNoise skin(fine);
    const double roughness = request["roughness"];
    const RadialFunction radius = [&](const V3d& d) {
        double bulge = 0;
        for (const Granule& g : granules) {
            const double away2 = (d - g.direction).length2(); // along the surface, which is about at distance 1
            if (away2 < g.radius2) bulge = std::max(bulge, std::sqrt(g.radius2 - away2) - g.sunk);
        }
        const double r = core(d) + bulge;
        return r * (1 + roughness * skin(r * d));
    };
    return radial_surface(radius, request.triangles);
}

} // namespace scree
