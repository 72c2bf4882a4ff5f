#include "render/build/grain_facts.h"

#include "base/hash.h"

namespace scree {

namespace {

/// Sums over grains. Absorption is weighted by cross-section, because light hits grains in proportion to it.
class FactSums {
public:
    void add(double radius, const Material& material)
    {
        ++facts_.count;
        facts_.mean_radius += radius;
        facts_.largest_radius = std::max(facts_.largest_radius, radius);
        const double section = radius * radius;
        facts_.loss += section * rough_loss(material, radius);
        sections_ += section;
    }
    GrainFacts means() const
    {
        GrainFacts facts = facts_;
        if (facts.count > 0) facts.mean_radius /= static_cast<double>(facts.count);
        if (sections_ > 0) facts.loss /= sections_;
        return facts;
    }

private:
    GrainFacts facts_;
    double sections_ = 0;
};

} // namespace

GrainFacts facts_of_list(const ParticleFrame& frame, const std::vector<uint8_t>& types,
                         const std::vector<GrainTypeDescription>& descriptions)
{
    FactSums sums;
    Imath::Box3d bounds;
    for (size_t i = 0; i < frame.size(); ++i) {
        const double radius = frame.radius[i];
        if (!(radius > 0)) continue;
        sums.add(radius, descriptions[types[i]].material);
        bounds.extendBy(frame.position[i] - V3d(radius));
        bounds.extendBy(frame.position[i] + V3d(radius));
    }
    GrainFacts facts = sums.means();
    facts.bounds = bounds;
    return facts;
}

GrainFacts facts_of_fill(const GrainFill& fill, const std::vector<GrainTypeDescription>& descriptions)
{
    constexpr uint64_t drawn = 4096; // sampled spheres: only the mixture knows the shares of the types
    const ProceduralFill& spheres = fill.fill();
    const uint64_t rows = spheres.tile().rows();
    FactSums sums;
    for (uint64_t n = 0; n < drawn; ++n) {
        const uint64_t random = hash_index(n, 0), row = mix64(random) % rows,
                       id = spheres.id(random % spheres.cell_count(), row);
        sums.add(spheres.radius(row), descriptions[fill.type(id)].material);
    }
    GrainFacts facts = sums.means();
    facts.count = static_cast<uint64_t>(std::ceil(spheres.expected_count()));
    facts.largest_radius = spheres.largest_radius();
    facts.mean_radius = 0; // replaces the sample's mean: all radii of the tile are known
    for (uint64_t row = 0; row < rows; ++row) facts.mean_radius += spheres.radius(row) / static_cast<double>(rows);
    facts.bounds = spheres.domain().bounds();
    return facts;
}

} // namespace scree
