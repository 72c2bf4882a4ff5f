#pragma once

#include "render/integrators/path_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/statistics.h"

#include <memory>
#include <string>
#include <vector>

namespace scree {

/// The grains of a bed, to compare proxies with explicit grains.
struct BedGrain {
    std::string name;
    Material material; ///< absorption for a grain of radius 1
    std::shared_ptr<const Exemplar> shape; ///< null: spheres
    std::shared_ptr<const Gsdf> gsdf;
};

/// Spheres of glass, absorbing glass and 0.9 white, and mesh grains: cubes of glass, sugar and flour of the library (at
/// their natural absorption).
std::vector<BedGrain> bed_grains(double gsdf_error);

/// A cube of grains of radius 1 with the pack rate `fraction`, lit by a bright upper half of the sky.
std::unique_ptr<TestScene> make_bed(const BedGrain& grain, double fraction, uint64_t count);
/// The same under a sun of the angular diameter `diameter` (degrees) and irradiance 3, and a dim sky.
std::unique_ptr<TestScene> make_bed_under_sun(const BedGrain& grain, double fraction, uint64_t count, double diameter);

/// Mean radiance of `paths` rays from above and from the sides towards the bed's middle.
Estimate bed_radiance(const TestScene& bed, uint32_t paths, uint32_t explicit_grains, uint64_t seed);

} // namespace scree
