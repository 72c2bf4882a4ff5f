// Grains over twelve decades of size in one scene: each is hit at its place, from near and from far.

#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/render/trace/brute_force.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr int least = -9, most = 3;

/// Eight separate grains per decade, around the middle; in the order of the decades.
void add_decades(TestScene& scene, uint32_t type)
{
    for (int decade = least; decade <= most; ++decade) {
        const double radius = std::pow(10.0, decade);
        for (int corner = 0; corner < 8; ++corner) {
            const V3d c(corner & 1 ? 2 : -2, corner & 2 ? 2 : -2, corner & 4 ? 2 : -2);
            scene.add_grain(c * radius, radius, type);
        }
    }
}

struct Met {
    uint64_t grain = ~uint64_t{0};
    double t = infinity;
    bool close = false; ///< a sphere is grazed within the rounding of a float
};

Met brute_force(const World& world, const V3d& o, const V3d& d)
{
    Met met;
    for (uint64_t i = 0; i < world.grains.size(); ++i) {
        const GrainSphere sphere = world.sphere(i);
        const V3d to = sphere.centre - o;
        const double along = to.dot(d), off = (to - along * d).length(), r = sphere.radius;
        const double t = along - std::sqrt(std::max(0.0, r * r - off * off));
        if (t <= 0) continue;
        met.close |= std::abs(off / r - 1) < 1e-4;
        if (off < r && t < met.t) {
            met.t = t;
            met.grain = i;
        }
    }
    return met;
}

TEST(SizeClasses, SpheresAreMetAsByBruteForce)
{
    TestScene scene;
    add_decades(scene, scene.add_type(lambert(0.5f)));
    scene.add_constant_light(1);
    scene.build();
    const World& world = scene.world();
    int checked = 0, close = 0, hits = 0;
    for (uint32_t n = 0; n < 40000; ++n) {
        Sampler sampler(5, n, 0, 0);
        const double away = world.space.length(std::pow(10.0, least + (most - least) * sampler.next()));
        const V3d o = random_direction(sampler) * away;
        const GrainSphere aim =
            world.sphere(static_cast<uint64_t>(sampler.next() * static_cast<double>(world.grains.size())));
        const V3d d = (aim.centre + aim.radius * random_direction(sampler) * sampler.next() - o).normalized();
        bool within = false;
        for (uint64_t i = 0; i < world.grains.size(); ++i)
            within |= (world.sphere(i).centre - o).length() < world.sphere(i).radius * 1.0001;
        if (within) continue;
        const Met met = brute_force(world, o, d);
        if (met.close) {
            ++close;
            continue;
        }
        ++checked;
        const Hit hit = scene.tracer().intersect(o, d, {});
        ASSERT_EQ(hit.place.kind == HitKind::grain, met.grain != ~uint64_t{0}) << n << ": from " << o << " along " << d;
        EXPECT_EQ(scene.tracer().occluded(o, d, infinity, {}, std::numeric_limits<uint32_t>::max()),
                  hit.place.kind == HitKind::grain)
            << n;
        if (hit.place.kind != HitKind::grain) continue;
        ++hits;
        ASSERT_EQ(hit.place.index, met.grain) << n;
        EXPECT_NEAR(hit.t, met.t, 1e-9 * (met.t + world.sphere(met.grain).radius)) << n;
    }
    EXPECT_GT(checked, 30000);
    EXPECT_GT(hits, 20000);
    EXPECT_LT(close, 400);
}

TEST(SizeClasses, MeshesAreMetFromNearby)
{
    TestScene scene;
    add_decades(scene, scene.add_type(lambert(0.5f), icosphere(2)));
    scene.add_constant_light(1);
    scene.build();
    const World& world = scene.world();
    for (uint32_t n = 0; n < 5000; ++n) {
        Sampler sampler(6, n, 0, 0);
        const auto grain = static_cast<uint64_t>(sampler.next() * static_cast<double>(world.grains.size()));
        const GrainSphere sphere = world.sphere(grain);
        const V3d d = random_direction(sampler), o = sphere.centre - d * (1.01 * sphere.radius);
        const Hit hit = scene.tracer().intersect(o, d, {});
        ASSERT_EQ(hit.place.kind, HitKind::grain) << grain;
        ASSERT_EQ(hit.place.index, grain);
        EXPECT_GT(hit.t, 0.009 * sphere.radius);
        EXPECT_LT(hit.t, 0.1 * sphere.radius);
        const Hit inside = scene.tracer().intersect(hit.point, -d, hit.place);
        EXPECT_TRUE(inside.place.kind == HitKind::none || inside.place.index != grain);
    }
}

} // namespace
} // namespace scree
