#pragma once

#include "render/media/clearance_field.h"
#include "render/trace/world.h"

#include <cstdint>
#include <memory>

namespace scree {

class EmbreeDevice;

/// Where a ray goes through the surface of a region.
struct Crossing {
    double t = 0;
    uint32_t region = 0, triangle = 0;
    bool enters = false;
};

/// A set of regions, one bit each.
using RegionSet = uint64_t;

/// Finds where rays go through the surfaces of a world's media.
///
/// Embree proposes triangles in float and double decides, so that what shares an edge is told apart by one number.
/// Where Embree met another triangle than the ray does, or none where there must be one, those are asked in whose boxes
/// the ray comes: no ray passes between two triangles. Rays are (o, d): unit d, render coordinates.
class RegionTracer {
public:
    static constexpr size_t most_regions = 64;

    /// Builds the structure over world.regions, which must outlive it.
    RegionTracer(std::shared_ptr<const EmbreeDevice> device, const World& world);
    ~RegionTracer();

    /// The first crossing in tmin < t < tmax. regions: that the ray is in at tmin; mended where what is ahead says
    /// otherwise. last: a crossing that the ray has just gone through, or null.
    bool next(const V3d& o, const V3d& d, double tmin, double tmax, const Crossing* last, RegionSet& regions,
              Crossing& crossing) const;
    /// The regions that o is in, found along d.
    RegionSet inside(const V3d& o, const V3d& d) const;
    /// `from` after a straight way from a to b.
    RegionSet after(RegionSet from, const V3d& a, const V3d& b) const;
    /// `from` after a crossing.
    static RegionSet after(RegionSet from, const Crossing& crossing)
    {
        const RegionSet bit = RegionSet{1} << crossing.region;
        return crossing.enters ? from | bit : from & ~bit;
    }
    /// Of the surface, outwards.
    V3d normal(const Crossing& crossing) const;
    /// The regions that stand for grains.
    RegionSet instead_of_grains() const { return instead_of_grains_; }
    /// No surface, light or region's surface is nearer to p than this; may be 0 where it is not above `least`.
    double clearance(const V3d& p, double least) const
    {
        return clearance_ ? clearance_->rough_clearance(p, least) : 0;
    }

private:
    /// Regions by the next crossing ahead: one that enters a region comes from outside of it. null: there is none, and
    /// the ray is outside of all.
    static RegionSet before(RegionSet regions, const Crossing* next)
    {
        if (!next) return 0;
        const RegionSet bit = RegionSet{1} << next->region;
        return next->enters ? regions & ~bit : regions | bit;
    }
    /// As next, for a ray of which nothing else is known. surely: not by Embree's triangles, which miss some where
    /// float is too coarse; becomes whether it was so.
    bool find(const V3d& o, const V3d& d, double tmin, double tmax, const Crossing* last, bool& surely,
              Crossing& crossing) const;

    struct Impl;
    std::unique_ptr<Impl> impl_;
    RegionSet instead_of_grains_ = 0;
    const ClearanceField* clearance_ = nullptr; ///< null: nothing is known
};

} // namespace scree
