#pragma once

#include "base/progress.h"
#include "render/equivalent/mixture_moments.h"
#include "render/trace/world.h"

#include <vector>

namespace scree {

/// What grains a packing is made of, by number: all that are listed, or a sample of those of a fill. Lengths in render
/// coordinates.
struct PackingSample {
    struct Grain {
        uint64_t row; ///< of the fill's tile, or place in the list
        double radius;
        uint8_t type;
    };
    std::vector<Grain> grains;
    double pack_rate =
        0; ///< of the bounding spheres, where grains are; of a list that of the three quarters that lie loosest

    double mean_radius() const;
    /// By volume: <r^4> / <r^3>.
    double volume_weighted_radius() const;
};

/// At most `most` grains, by hash. Empty where there are none.
PackingSample sample_packing(const World& world, uint64_t most, const Progress& progress);

/// The moments of types that are met again and again, with their albedo between some radii of the sample's range.
class MomentTable {
public:
    MomentTable(const std::vector<GrainType>& types, const PackingSample& sample);
    /// Grains of a type, their radii as one or two that have the same sums of r^2, r^3 and r^4.
    void add_shares(uint8_t type, double m2, double m3, double m4, std::vector<GrainShare>& shares) const;

private:
    struct Type {
        const Gsdf* gsdf = nullptr;
        Material material;
        GrainMoments moments;
        double least = 0, step = 0; ///< logarithms of radii
        std::vector<GrainAlbedo> albedo; ///< at exp(least + i step); one where it is the same for all
    };
    static GrainAlbedo albedo_at(const Type& type, double radius);

    std::vector<Type> types_;
};

/// The grains as shares of a mixture.
std::vector<GrainShare> shares_of(const PackingSample& sample, const MomentTable& table);

} // namespace scree
