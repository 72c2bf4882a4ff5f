#pragma once

#include "render/trace/world.h"

#include <memory>
#include <vector>

struct RTCFilterFunctionNArguments;
struct RTCSceneTy;

namespace scree {

struct TracerQuery;

/// Intersects rays with the grains of a procedural fill: cell by cell along the ray's segments inside the domain, with
/// one Embree scene for each variant of the tile.
///
/// Embree proposes spheres of the tile; the exact hit is computed for the sphere at its place in the scene, as for
/// listed grains. A cell's scene holds the tile's spheres and those spheres of the neighbouring cells that reach into
/// the cell; all variants share the latter.
class FillTracer {
public:
    /// `world` must have a fill and must outlive this object.
    FillTracer(std::shared_ptr<const EmbreeDevice> device, const World& world);
    ~FillTracer();

    /// Offers the query the grains that its ray may hit, if they are nearer than its nearest hit.
    void find_nearest(TracerQuery& query) const { walk(query, false); }
    /// The same, but stops at the first accepted grain.
    void find_any(TracerQuery& query) const { walk(query, true); }

    struct Visit; ///< the visit of one ray to one cell

private:
    /// A sphere of a cell's scene: a row of the tile, in the cell itself or in a neighbouring cell.
    struct Entry {
        uint32_t row;
        int8_t dx, dy, dz;
    };
    struct Variant {
        RTCSceneTy* scene = nullptr;
        std::vector<Entry> entries; // indexed by Embree's primitive id
    };
    struct Inside;
    /// A ray's crossing of the domain's surface: somewhere between begin and end (tile units along the ray).
    struct Crossing {
        double begin, end;
        bool enters; ///< true: certainly enters; false: leaves or unclear
    };

    void make_variant(uint32_t variant);
    void make_domain();
    void walk(TracerQuery& query, bool any) const;
    /// The first crossing from s to end; false when there is none.
    bool next_crossing(const TracerQuery& query, double s, double end, Crossing& crossing) const;
    /// The first part of the ray inside the domain from s on; it may begin before the exact part and end after it.
    /// False when there is none.
    bool find_inside(const TracerQuery& query, double s, Inside& inside) const;
    /// Extends a part that goes on: to its end, or to `end` if that comes first.
    void follow_inside(const TracerQuery& query, double end, Inside& inside) const;
    /// Where a ray from outside enters the domain's bounds; false when it misses them.
    bool reaches_domain(const TracerQuery& query, double& s) const;
    void visit(Visit& visit, double begin, double end, bool any) const;

    friend void fill_filter(const RTCFilterFunctionNArguments* args);

    std::shared_ptr<const EmbreeDevice> device_;
    const World& world_;
    const ProceduralFill& fill_;
    std::vector<Variant> variants_;
    RTCSceneTy* domain_ = nullptr;
    double rate_ = 1; // tile units per unit of render length
    double margin_ = 0; // tile units: error of points in a cell, float against double
    double step_back_ = 0; // tile units
    double reach_ = 0; // tile units: the largest diameter if grains may be meshes, else 0
    FloatMargin float_margin_; // for the spheres in the tile's scenes
};

} // namespace scree
