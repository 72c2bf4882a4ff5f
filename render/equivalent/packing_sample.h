#pragma once

#include "base/progress.h"
#include "render/equivalent/mixture_moments.h"
#include "render/trace/world.h"

#include <vector>

namespace scree {

/// The grains of a packing, by number: those of a list, or those of a fill; a sample if there are many. Lengths in
/// render coordinates.
struct PackingSample {
    struct Grain {
        uint64_t row; ///< row of the fill's tile, or index in the list
        double radius;
        uint8_t type;
    };
    std::vector<Grain> grains;
    /// Pack rate of the bounding spheres at the grains; for a list, the 75th percentile of the rates at its grains.
    double pack_rate = 0;

    double mean_radius() const;
    /// The mean radius weighted by volume: <r^4> / <r^3>.
    double volume_weighted_radius() const;
};

/// A sample of at most `most` grains, chosen by hash; empty if there are no grains.
PackingSample sample_packing(const World& world, uint64_t most, const Progress& progress);

/// A cache of the moments of each type, with its albedo tabulated over the sample's range of radii.
class MomentTable {
public:
    MomentTable(const std::vector<GrainType>& types, const PackingSample& sample);
    /// Adds the grains of a type as one or two radii with the same sums of r^2, r^3 and r^4.
    void add_shares(uint8_t type, double m2, double m3, double m4, std::vector<GrainShare>& shares) const;

private:
    struct Type {
        const Gsdf* gsdf = nullptr;
        Material material;
        GrainMoments moments;
        double least = 0, step = 0; ///< in logarithms of the radius
        /// albedo at radius exp(least + i step); one element if it is the same for all radii
        std::vector<GrainAlbedo> albedo;
    };
    static GrainAlbedo albedo_at(const Type& type, double radius);

    std::vector<Type> types_;
};

/// The sampled grains as shares of a mixture.
std::vector<GrainShare> shares_of(const PackingSample& sample, const MomentTable& table);

} // namespace scree
