#include "tests/render/trace/brute_force.h"

#include "render/embree/triangle.h"

namespace scree {

V3d random_direction(Sampler& sampler)
{
    const double z = 2 * sampler.next() - 1, phi = 2 * pi * sampler.next(), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

V3d random_point(Sampler& sampler, double half)
{
    return half * V3d(2 * sampler.next() - 1, 2 * sampler.next() - 1, 2 * sampler.next() - 1);
}

std::array<V3d, 3> grain_triangle(const World& world, uint32_t grain, uint32_t triangle)
{
    const Imath::M33d rotation = world.rotation(grain);
    auto corners = world.types[world.grains.type_codes[grain]].exemplar->corners(triangle);
    for (V3d& p : corners) p = world.grains.centre(grain) + (p * rotation) * world.grains.radius(grain);
    return corners;
}

std::array<V3d, 3> surface_triangle(const World& world, uint32_t surface, uint32_t triangle)
{
    const auto& t = world.surfaces[surface].triangles[triangle];
    const auto& p = world.surfaces[surface].positions;
    return {V3d(p[t[0]]), V3d(p[t[1]]), V3d(p[t[2]])};
}

BruteForce::BruteForce(const World& world) : world_(world)
{
    for (uint32_t i = world.grains.analytic_count; i < world.grains.size(); ++i) {
        first_of_grain_.push_back(triangles_.size());
        const uint64_t count = world.types[world.grains.type_codes[i]].exemplar->triangle_count();
        for (uint32_t k = 0; k < count; ++k) add({HitKind::grain, i, k}, grain_triangle(world, i, k));
    }
    first_of_grain_.push_back(triangles_.size());
    for (uint32_t i = 0; i < world.surfaces.size(); ++i) {
        for (uint32_t k = 0; k < world.surfaces[i].triangles.size(); ++k)
            add({HitKind::surface, i, k}, surface_triangle(world, i, k));
    }
}

Truth BruteForce::outside(const V3d& o, const V3d& d, const Place& from) const
{
    Truth truth;
    for (uint32_t i = 0; i < world_.grains.analytic_count; ++i) try_sphere(i, o, d, from, truth);
    for (const Triangle& triangle : triangles_) try_triangle(triangle, true, o, d, from, truth);
    truth.judge();
    return truth;
}

Truth BruteForce::inside(uint32_t grain, const V3d& o, const V3d& d, const Place& from) const
{
    Truth truth;
    size_t k = first_of_grain_.back();
    if (grain < world_.grains.analytic_count) {
        const V3d to = world_.grains.centre(grain) - o;
        const double along = to.dot(d), r = world_.grains.radius(grain);
        truth.offer({HitKind::grain, grain, no_triangle}, along + safe_sqrt(r * r - (to - along * d).length2()));
    } else {
        const size_t mesh = grain - world_.grains.analytic_count;
        for (size_t j = first_of_grain_[mesh]; j < first_of_grain_[mesh + 1]; ++j)
            try_triangle(triangles_[j], false, o, d, from, truth);
    }
    for (; k < triangles_.size(); ++k) try_triangle(triangles_[k], false, o, d, from, truth);
    truth.judge();
    return truth;
}

void BruteForce::add(const Place& place, const std::array<V3d, 3>& c)
{
    const double longest = std::max({(c[1] - c[0]).length(), (c[2] - c[0]).length(), (c[2] - c[1]).length()});
    triangles_.push_back({place, c, unit_normal(c), (c[1] - c[0]).cross(c[2] - c[0]).length() / longest});
}

// A sphere is hit where the ray enters it; a sphere that contains the start is not hit.
void BruteForce::try_sphere(uint32_t i, const V3d& o, const V3d& d, const Place& from, Truth& truth) const
{
    if (from.kind == HitKind::grain && from.index == i) return;
    const V3d to = world_.grains.centre(i) - o;
    const double r = world_.grains.radius(i), along = to.dot(d), nearest = (to - along * d).length();
    if (to.length() < r || along <= 0) return;
    if (std::abs(nearest - r) < float_margin * (1 + along)) truth.doubt(along - r);
    if (nearest < r) truth.offer({HitKind::grain, i, no_triangle}, along - std::sqrt(r * r - nearest * nearest));
}

// Of a grain's triangles only those through which the ray enters (or leaves) count; of surfaces all.
void BruteForce::try_triangle(const Triangle& triangle, bool entering, const V3d& o, const V3d& d, const Place& from,
                              Truth& truth)
{
    const Place& place = triangle.place;
    if (from.kind == place.kind && from.index == place.index && from.triangle == place.triangle) return;
    const V3d e1 = triangle.c[1] - triangle.c[0], e2 = triangle.c[2] - triangle.c[0], p = d.cross(e2);
    const double det = e1.dot(p), cosine = triangle.normal.dot(d);
    const bool wanted = place.kind == HitKind::surface || (cosine < 0) == entering;
    if (det == 0 || (!wanted && std::abs(cosine) > 1e-6)) return;
    const V3d s = o - triangle.c[0], q = s.cross(e1);
    const double u = s.dot(p) / det, v = d.dot(q) / det, t = e2.dot(q) / det, within = std::min({u, v, 1 - u - v});
    const double slack = float_margin / std::max(1e-4, std::abs(cosine)), margin = slack / triangle.height;
    if (t > -slack && (std::abs(within) < margin || (within > 0 && (t < slack || !wanted)))) truth.doubt(t);
    if (wanted && within >= 0 && t > 0) truth.offer(place, t);
}

} // namespace scree
