// A ray never hits the primitive on which it starts, closed meshes have no leaks, and lights are hit at their place.

#include "render/embree/triangle.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/render/trace/brute_force.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

/// Directions on the side of n: random ones, grazing ones, and n itself.
V3d leaving_direction(Sampler& sampler, const V3d& n, int i)
{
    V3d d = random_direction(sampler);
    if (i % 4 == 1) d = d - d.dot(n) * n + std::pow(10, -8 * sampler.next()) * n;
    if (i % 16 == 2) d = n;
    if (d.dot(n) < 0) d = -d;
    return d.normalized();
}

TEST(TracerStart, LeavingASphereNeverMeetsItAgain)
{
    TestScene scene;
    const uint32_t clay = scene.add_type(lambert(1));
    Sampler sampler(6, 0, 0, 0);
    for (const double radius : {1.0, 1e-1, 1e-3, 1e-6, 1e-9}) scene.add_grain(random_point(sampler, 100), radius, clay);
    scene.build();
    for (int i = 0; i < 100000; ++i) {
        const auto grain = static_cast<uint32_t>(i) % 5;
        const V3d n = random_direction(sampler), d = leaving_direction(sampler, n, i);
        const V3d o = scene.world().grains.centre(grain) + scene.world().grains.radius(grain) * n;
        const Place from{HitKind::grain, grain, no_triangle};
        const Hit hit = scene.tracer().intersect(o, d, from);
        ASSERT_FALSE(hit.place.kind == HitKind::grain && hit.place.index == grain)
            << grain << " from " << o << " along " << d;
        ASSERT_TRUE(hit.place.kind != HitKind::none || !scene.tracer().occluded(o, d, infinity, from, 0));
    }
}

/// A point of a triangle: a corner, on an edge, or within, as i says.
V3d point_of(const std::array<V3d, 3>& c, Sampler& sampler, int i)
{
    double u = sampler.next(), v = sampler.next();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    switch (i % 6) {
    case 0: return c[static_cast<size_t>(i / 6 % 3)];
    case 1: return c[0] + u * (c[1] - c[0]);
    case 2: return c[0] + u * (c[2] - c[0]);
    case 3: return c[1] + u * (c[2] - c[1]);
    case 4: u *= 1e-7; break; // near an edge
    default: break;
    }
    return c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
}

// A ray outwards from a face of a convex solid never hits the solid, also from its edges and corners; far from the
// origin, where a float is coarse, and for tiny solids.
TEST(TracerStart, LeavingAConvexMeshGrainNeverMeetsItAgain)
{
    TestScene scene;
    const uint32_t types[] = {scene.add_type(lambert(1), cube()), scene.add_type(dielectric(1.5), icosphere(2))};
    Sampler sampler(7, 0, 0, 0);
    const double radii[] = {1.0, 1e-2, 1e-4, 1e-6};
    for (int i = 0; i < 8; ++i) scene.add_grain(random_point(sampler, 20), radii[i / 2], types[i % 2]);
    scene.build();
    const World& world = scene.world();
    int wrong = 0;
    for (int i = 0; i < 100000; ++i) {
        const auto grain = static_cast<uint32_t>(sampler.next() * 8);
        const auto& exemplar = *world.types[world.grains.type_codes[grain]].exemplar;
        const auto triangle = static_cast<uint32_t>(sampler.next() * static_cast<double>(exemplar.triangle_count()));
        const auto corners = grain_triangle(world, grain, triangle);
        const V3d o = point_of(corners, sampler, i), d = leaving_direction(sampler, unit_normal(corners), i);
        const Place from{HitKind::grain, grain, triangle};
        const Hit hit = scene.tracer().intersect(o, d, from);
        const bool again = hit.place.kind == HitKind::grain && hit.place.index == grain;
        const bool shadowed = hit.place.kind == HitKind::none && scene.tracer().occluded(o, d, infinity, from, 0);
        if ((again || shadowed) && ++wrong < 4) {
            ADD_FAILURE() << "grain " << grain << " triangle " << triangle << " from " << o << " (case " << i % 6
                          << ") along " << d << ", cosine " << d.dot(unit_normal(corners)) << ", met triangle "
                          << hit.place.triangle << " at " << hit.t;
        }
    }
    EXPECT_EQ(wrong, 0);
}

// A ray inwards from a face, an edge or a corner: it goes on inside, never through the face on which it starts, never
// farther than the solid is wide, and is hardly ever lost.
TEST(TracerStart, RaysIntoAConvexMeshGrainComeOut)
{
    TestScene scene;
    const uint32_t types[] = {scene.add_type(dielectric(1.5), cube()), scene.add_type(dielectric(1.5), icosphere(2))};
    Sampler sampler(8, 0, 0, 0);
    const double radii[] = {1.0, 1e-2, 1e-4, 1e-6};
    for (int i = 0; i < 8; ++i) scene.add_grain(random_point(sampler, 20), radii[i / 2], types[i % 2]);
    scene.build();
    const World& world = scene.world();
    int wrong = 0, lost_within = 0, lost_at_edges = 0;
    for (int i = 0; i < 100000; ++i) {
        const auto grain = static_cast<uint32_t>(sampler.next() * 8);
        const auto& exemplar = *world.types[world.grains.type_codes[grain]].exemplar;
        const auto triangle = static_cast<uint32_t>(sampler.next() * static_cast<double>(exemplar.triangle_count()));
        const auto corners = grain_triangle(world, grain, triangle);
        const V3d o = point_of(corners, sampler, i), d = leaving_direction(sampler, -unit_normal(corners), i);
        const Hit hit = scene.tracer().intersect_inside({HitKind::grain, grain, no_triangle, world.type(grain)}, o, d,
                                                        {HitKind::grain, grain, triangle});
        const double r = world.grains.radius(grain);
        if (hit.place.kind == HitKind::none) {
            (i % 6 == 5 ? lost_within : lost_at_edges) += 1;
            continue;
        }
        const bool right =
            hit.place.index == grain && hit.place.triangle != triangle && hit.t >= 0 && hit.t <= 2.001 * r &&
            hit.normal.dot(d) > 0 &&
            (hit.point - (o + hit.t * d)).length() < 2 * float_margin * r / std::max(1e-4, hit.normal.dot(d));
        if (!right && ++wrong < 4) {
            ADD_FAILURE() << "grain " << grain << " triangle " << triangle << " from " << o << " along " << d
                          << ": triangle " << hit.place.triangle << " at " << hit.t / r << " radii, "
                          << (hit.point - (o + hit.t * d)).length() / r << " off the ray";
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_LE(lost_within, 1);
    std::printf("lost: %d from within faces, %d from edges and corners\n", lost_within, lost_at_edges);
}

// A closed convex surface, an open plane of many triangles, and one far from the origin.
TEST(TracerStart, LeavingASurfaceNeverMeetsItAgain)
{
    TestScene scene;
    TriangleMesh box = cube(), ball = icosphere(2);
    for (V3d& p : box.positions) p = 0.3 * p + V3d(0.2, 0.1, 0.3);
    for (V3d& p : ball.positions) p = 0.01 * p + V3d(57.3, -33.1, 21.7);
    TriangleMesh plane;
    for (int j = 0; j <= 8; ++j) {
        for (int i = 0; i <= 8; ++i)
            plane.positions.push_back(V3d(-3, 0.1, 0) + 0.123 * i * V3d(1, 0.2, 0.1) + 0.177 * j * V3d(-0.1, 1, 0.3));
    }
    for (uint32_t j = 0; j < 8; ++j) {
        for (uint32_t i = 0; i < 8; ++i) {
            const uint32_t at = 9 * j + i;
            plane.triangles.insert(plane.triangles.end(), {{at, at + 1, at + 10}, {at, at + 10, at + 9}});
        }
    }
    const TriangleMesh meshes[] = {box, ball, ground(0.7, -2.3)};
    for (const TriangleMesh& mesh : meshes) scene.add_surface(mesh, lambert(1));
    scene.build();
    const World& world = scene.world();
    Sampler sampler(9, 0, 0, 0);
    int wrong = 0;
    for (int i = 0; i < 150000; ++i) {
        const auto index = static_cast<uint32_t>(sampler.next() * 3);
        const Surface& surface = world.surfaces[index];
        const auto triangle = static_cast<uint32_t>(sampler.next() * static_cast<double>(surface.triangles.size()));
        const auto& t = surface.triangles[triangle];
        const std::array<V3d, 3> corners{V3d(surface.positions[t[0]]), V3d(surface.positions[t[1]]),
                                         V3d(surface.positions[t[2]])};
        const V3d n = unit_normal(corners) * (index == 2 && i % 2 ? -1 : 1); // rays start on both sides of the plane
        const V3d o = point_of(corners, sampler, i), d = leaving_direction(sampler, n, i);
        const Place from{HitKind::surface, index, triangle};
        const Hit hit = scene.tracer().intersect(o, d, from);
        const bool again = hit.place.kind == HitKind::surface && hit.place.index == index;
        const bool shadowed = hit.place.kind == HitKind::none && scene.tracer().occluded(o, d, infinity, from, 0);
        if ((again || shadowed) && ++wrong < 4) {
            ADD_FAILURE() << "surface " << index << " triangle " << triangle << " from " << o << " (case " << i % 6
                          << ") along " << d << ", cosine " << d.dot(n) << ", met triangle " << hit.place.triangle
                          << " at " << hit.t;
        }
    }
    EXPECT_EQ(wrong, 0);
}

// Rays aimed exactly at edges and corners of a closed mesh never slip through between its triangles.
TEST(TracerWatertight, RaysAtEdgesAndCornersDoNotSlipThrough)
{
    TestScene scene;
    const uint32_t gem = scene.add_type(dielectric(1.5), icosphere(2));
    scene.add_grain(V3d(0.3, 0.2, 0.1), 0.9, gem);
    TriangleMesh ball = icosphere(2);
    for (V3d& p : ball.positions) p = 0.7 * p + V3d(4, 0, 0);
    scene.add_surface(ball, lambert(1));
    scene.build();
    const World& world = scene.world();
    Sampler sampler(10, 0, 0, 0);
    int through_grain = 0, through_surface = 0;
    const V3d middle(world.grains.centre(0));
    V3d ball_middle(0);
    for (const V3f& p : world.surfaces[0].positions)
        ball_middle += V3d(p) / static_cast<double>(world.surfaces[0].positions.size());
    for (int i = 0; i < 60000; ++i) {
        const auto triangle = static_cast<uint32_t>(sampler.next() * 320);
        const V3d on_grain = point_of(grain_triangle(world, 0, triangle), sampler, i % 4);
        const V3d away = (on_grain - middle).normalized();
        V3d side = random_direction(sampler);
        const V3d o = on_grain + 0.2 * away + 0.15 * side, d = (on_grain - o).normalized();
        const Hit hit = scene.tracer().intersect(o, d, {});
        through_grain += hit.place.kind != HitKind::grain || hit.t > (on_grain - o).length() + 1e-5;
        const auto& t = world.surfaces[0].triangles[triangle];
        const std::array<V3d, 3> corners{V3d(world.surfaces[0].positions[t[0]]), V3d(world.surfaces[0].positions[t[1]]),
                                         V3d(world.surfaces[0].positions[t[2]])};
        const V3d target = point_of(corners, sampler, i % 4), inside = ball_middle + 0.1 * random_direction(sampler);
        const Hit wall = scene.tracer().intersect(inside, (target - inside).normalized(), {});
        through_surface += wall.place.kind != HitKind::surface;
    }
    EXPECT_EQ(through_grain, 0);
    EXPECT_EQ(through_surface, 0);
}

// A chain of refractions and reflections in one grain: a leak would show as a ray lost inside.
TEST(TracerWatertight, LongWalksInsideAreNotLost)
{
    TestScene scene;
    const uint32_t types[] = {scene.add_type(dielectric(1.5), icosphere(3)), scene.add_type(dielectric(1.5), cube())};
    for (int i = 0; i < 10; ++i) scene.add_grain(V3d(2.2 * i, 0, 0), 1, types[i % 2]);
    scene.build();
    Sampler sampler(11, 0, 0, 0);
    uint64_t steps = 0, lost = 0;
    for (uint32_t w = 0; w < 400; ++w) {
        const uint32_t grain = w % 10;
        V3d o = scene.world().grains.centre(grain), d = random_direction(sampler);
        Place from;
        for (int step = 0; step < 500; ++step) {
            const Hit hit = scene.tracer().intersect_inside(
                {HitKind::grain, grain, no_triangle, scene.world().type(grain)}, o, d, from);
            ++steps;
            if (hit.place.kind == HitKind::none) {
                ++lost;
                break;
            }
            ASSERT_EQ(hit.place.index, grain);
            ASSERT_LE((hit.point - scene.world().grains.centre(grain)).length(),
                      scene.world().grains.radius(grain) * (1 + 1e-6));
            o = hit.point;
            from = hit.place;
            // A mirror on even steps, any direction inwards on odd ones.
            if (step % 2 == 0)
                d = (d - 2 * d.dot(hit.normal) * hit.normal).normalized();
            else
                d = leaving_direction(sampler, -hit.normal, 0);
        }
    }
    std::printf("%llu of %llu segments inside were lost\n", static_cast<unsigned long long>(lost),
                static_cast<unsigned long long>(steps));
    EXPECT_LE(lost, steps / 100000);
}

// --- lights ---

TEST(TracerLights, AreMetWhereTheyAreAndTheTargetDoesNotOcclude)
{
    TestScene scene;
    const uint32_t clay = scene.add_type(lambert(1));
    scene.add_grain(V3d(0), 0.5, clay);
    scene.add_light(rectangle_light(V3d(-0.2, -0.2, 0.9), V3d(0.4, 0, 0), V3d(0, 0.4, 0)));
    scene.add_constant_light(1);
    scene.add_light(sphere_light(V3d(0, 0, 2), 0.3));
    scene.build();
    const double unit = scene.space().length(1);
    const V3d up(0, 0, 1), o = unit * V3d(0.05, 0.03, 0.6);
    const Hit hit = scene.tracer().intersect(o, up, {});
    ASSERT_EQ(hit.place.kind, HitKind::light);
    EXPECT_EQ(hit.place.index, 0u);
    EXPECT_NEAR(hit.t, unit * 0.3, 1e-12);
    EXPECT_FALSE(scene.tracer().occluded(o, up, unit * 0.3, {}, 0)) << "the target itself";
    EXPECT_TRUE(scene.tracer().occluded(o, up, unit * 1.1, {}, 2)) << "the rectangle hides the sphere";
    const V3d above = unit * V3d(0.05, 0.03, 1.2);
    const Hit ball = scene.tracer().intersect(above, up, {});
    ASSERT_EQ(ball.place.kind, HitKind::light);
    EXPECT_EQ(ball.place.index, 2u);
    EXPECT_FALSE(scene.tracer().occluded(above, up, ball.t, {}, 2));
    EXPECT_TRUE(scene.tracer().occluded(above, -up, infinity, {}, 2)) << "rectangle and grain below";
    EXPECT_EQ(scene.tracer().intersect(above, -up, {}).place.index, 0u);
}

} // namespace
} // namespace scree
