#include "render/gsdf/grain_walk.h"

#include "render/materials/bsdf.h"

namespace scree {

namespace {

// A mesh that intersects itself has pockets that a path can enter but not leave. Where a grain is not white, such a
// path has lost all its light long before these limits.
constexpr uint32_t most_events = 1000000, most_opaque_events = 4096;
constexpr double rounding = 0x1p-50; // of positions in the unit sphere

/// A path's next hit on the grain's surface.
struct Step {
    V3d point, normal;
    double t = 0;
    uint32_t triangle = no_triangle;
};

/// Finds the next face from o along d; false when the path leaves the sphere.
bool next_face(const Exemplar& exemplar, const V3d& o, const V3d& d, bool inside, uint32_t skip, Step& step)
{
    ExemplarHit hit;
    if (!exemplar.intersect(o, d, rounding, 2.5, inside ? Facing::leaving : Facing::entering, skip, hit)) return false;
    step = {exemplar.point(hit), exemplar.normal(hit.triangle), hit.t, hit.triangle};
    return true;
}

/// The same for a grain that is the unit sphere: the path enters where it starts, and next meets the end of a chord.
bool next_face(const V3d& o, const V3d& d, bool inside, bool first, Step& step)
{
    if (!inside && !first) return false;
    const double chord = inside ? std::max(0.0, -2 * o.dot(d)) : 0;
    step.point = (o + chord * d).normalized();
    step.normal = step.point;
    step.t = chord;
    return true;
}

} // namespace

Material lossless(const Material& material)
{
    Material pure = material;
    pure.absorption = Color(0);
    pure.tint = Color(1);
    pure.reflectance = Color(1);
    return pure;
}

GrainExit walk_grain(const GrainBody& body, V3d o, V3d d, Sampler& sampler)
{
    GrainExit exit;
    bool inside = false;
    Step step;
    for (;;) {
        const bool met = body.exemplar ? next_face(*body.exemplar, o, d, inside, step.triangle, step)
                                       : next_face(o, d, inside, exit.events == 0, step);
        if (!met) {
            if (!inside) break;
            inside = false; // slipped out between two triangles: goes on as if the interface were not there
            step.triangle = no_triangle;
            continue;
        }
        if (inside) exit.length += step.t;
        const Frame frame(step.normal);
        const BsdfSample sample = sample_bsdf(body.material, frame.to_local(-d), sampler);
        if (!sample.valid || ++exit.events > (body.material.transmits() ? most_events : most_opaque_events)) {
            exit.lost = true;
            return exit;
        }
        exit.weight *= sample.weight;
        if (body.material.transmits()) inside = sample.wi.z < 0;
        o = step.point;
        d = frame.to_world(sample.wi).normalized();
    }
    const double along = o.dot(d);
    exit.point = (o + (safe_sqrt(along * along + 1 - o.length2()) - along) * d).normalized();
    exit.direction = d;
    return exit;
}

} // namespace scree
