#pragma once

#include "render/media/clearance_field.h"
#include "render/trace/world.h"

#include <cstdint>
#include <memory>

namespace scree {

class EmbreeDevice;

/// The crossing of a ray through the surface of a region.
struct Crossing {
    double t = 0;
    uint32_t region = 0, triangle = 0;
    bool enters = false;
};

/// A set of regions, one bit each.
using RegionSet = uint64_t;

/// Finds where rays cross the surfaces of a world's media.
///
/// Embree proposes triangles in float, and double precision decides: for two triangles that share an edge the decision
/// is the sign of one number. If Embree hits another triangle than the exact ray, or none where there must be one, all
/// triangles whose boxes the ray enters are tested. So no ray passes between two triangles. Rays are (o, d): unit d,
/// render coordinates.
class RegionTracer {
public:
    static constexpr size_t most_regions = 64;

    /// Builds the structure over world.regions, which must outlive this object.
    RegionTracer(std::shared_ptr<const EmbreeDevice> device, const World& world);
    ~RegionTracer();

    /// The first crossing in tmin < t < tmax. regions: the regions that contain the ray at tmin; corrected if the
    /// crossings ahead say otherwise. last: the crossing that the ray has just passed, or null.
    bool next(const V3d& o, const V3d& d, double tmin, double tmax, const Crossing* last, RegionSet& regions,
              Crossing& crossing) const;
    /// The regions that contain o, found by a ray along d.
    RegionSet inside(const V3d& o, const V3d& d) const;
    /// The regions after a straight path from a to b that starts in the regions `from`.
    RegionSet after(RegionSet from, const V3d& a, const V3d& b) const;
    /// The regions after a crossing out of the regions `from`.
    static RegionSet after(RegionSet from, const Crossing& crossing)
    {
        const RegionSet bit = RegionSet{1} << crossing.region;
        return crossing.enters ? from | bit : from & ~bit;
    }
    /// The unit normal of the surface at a crossing, outwards.
    V3d normal(const Crossing& crossing) const;
    /// The regions whose medium replaces the grains inside.
    RegionSet instead_of_grains() const { return instead_of_grains_; }
    /// A lower bound of the distance from p to the nearest surface, light or region surface; may be 0 where it is
    /// `least` or less.
    double clearance(const V3d& p, double least) const
    {
        return clearance_ ? clearance_->rough_clearance(p, least) : 0;
    }

private:
    /// The regions before the next crossing: a ray that enters a region there comes from outside it. null: there is no
    /// crossing ahead, and the ray is outside all regions.
    static RegionSet before(RegionSet regions, const Crossing* next)
    {
        if (!next) return 0;
        const RegionSet bit = RegionSet{1} << next->region;
        return next->enters ? regions & ~bit : regions | bit;
    }
    /// Like next(), without known regions. surely: in: whether to test boxes instead of Embree's triangles, which are
    /// missed where float is too coarse; out: whether boxes were tested.
    bool find(const V3d& o, const V3d& d, double tmin, double tmax, const Crossing* last, bool& surely,
              Crossing& crossing) const;

    struct Impl;
    std::unique_ptr<Impl> impl_;
    RegionSet instead_of_grains_ = 0;
    const ClearanceField* clearance_ = nullptr; ///< null: no bound is known
};

} // namespace scree
