#pragma once

#include "render/trace/world.h"

#include <memory>
#include <vector>

struct RTCFilterFunctionNArguments;
struct RTCSceneTy;

namespace scree {

struct TracerQuery;

/// Finds what a ray meets among the grains of a procedural fill: cell by cell along its segments inside the domain, one
/// Embree scene for each variant of the tile.
///
/// Embree proposes spheres of the tile; what is met is decided for the sphere as it lies in the scene, just as for
/// listed grains. A cell's scene has the tile's spheres and those of its neighbours that reach into it, which all
/// variants share.
class FillTracer {
public:
    /// `world` has a fill, and outlives this.
    FillTracer(std::shared_ptr<const EmbreeDevice> device, const World& world);
    ~FillTracer();

    /// Offers the query the grains its ray may meet, nearer than what it has.
    void find_nearest(TracerQuery& query) const { walk(query, false); }
    /// The same until there is one.
    void find_any(TracerQuery& query) const { walk(query, true); }

    struct Visit; ///< of one ray to one cell

private:
    /// A sphere of a cell's scene: a row of the tile, in the cell itself or in a neighbour.
    struct Entry {
        uint32_t row;
        int8_t dx, dy, dz;
    };
    struct Variant {
        RTCSceneTy* scene = nullptr;
        std::vector<Entry> entries; // by Embree's primitive
    };
    struct Inside;
    /// Of a ray and the domain's surface: somewhere from begin to end (tile units along the ray).
    struct Crossing {
        double begin, end;
        bool enters; ///< for certain
    };

    void make_variant(uint32_t variant);
    void make_domain();
    void walk(TracerQuery& query, bool any) const;
    /// The first crossing from s to end; false when there is none.
    bool next_crossing(const TracerQuery& query, double s, double end, Crossing& crossing) const;
    /// The first part of the ray inside the domain from s on: it may begin before the true one and end after it. False
    /// when there is none.
    bool find_inside(const TracerQuery& query, double s, Inside& inside) const;
    /// Looks for the end of a part that goes on, up to `end`.
    void follow_inside(const TracerQuery& query, double end, Inside& inside) const;
    /// Where the ray, from outside, comes into the domain's bounds; false when it does not.
    bool reaches_domain(const TracerQuery& query, double& s) const;
    void visit(Visit& visit, double begin, double end, bool any) const;

    friend void fill_filter(const RTCFilterFunctionNArguments* args);

    std::shared_ptr<const EmbreeDevice> device_;
    const World& world_;
    const ProceduralFill& fill_;
    std::vector<Variant> variants_;
    RTCSceneTy* domain_ = nullptr;
    double rate_ = 1; // tile units a unit of length of the scene as rendered
    double margin_ = 0; // tile units: of places in a cell, float against double
    double step_back_ = 0; // tile units
    double reach_ = 0; // tile units: the largest diameter, if grains may be meshes
    FloatMargin float_margin_; // of the spheres in the tile's scenes
};

} // namespace scree
