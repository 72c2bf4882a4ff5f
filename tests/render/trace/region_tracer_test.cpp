// Rays leave closed surfaces of media as often as they enter them, wherever they start and however near to edges and
// corners they pass.

#include "render/trace/region_tracer.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/render/trace/brute_force.h"

#include <gtest/gtest.h>

#include <memory>

namespace scree {
namespace {

/// A scene of one medium.
std::unique_ptr<TestScene> scene_of(const TriangleMesh& mesh)
{
    auto scene = std::make_unique<TestScene>();
    scene->add_medium(mesh, V3d(1), Color(1), 0);
    scene->build();
    return scene;
}

/// A ball of 5,120 triangles away from the origin.
const TestScene& ball_scene()
{
    static const std::unique_ptr<TestScene> scene = [] {
        TriangleMesh ball = icosphere(4);
        for (V3d& p : ball.positions) p = p * 0.75 + V3d(0.4, -0.2, 0.1);
        return scene_of(ball);
    }();
    return *scene;
}

std::array<V3d, 3> corners_of(const MediumRegion& region, size_t triangle)
{
    const auto& t = region.triangles[triangle];
    return {V3d(region.positions[t[0]]), V3d(region.positions[t[1]]), V3d(region.positions[t[2]])};
}

/// A point on a triangle: at a corner, on an edge, as near to one as `depth`, or anywhere.
V3d place_on(const std::array<V3d, 3>& c, Sampler& sampler, int i, double depth)
{
    double u = sampler.next(), v = sampler.next();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    if (i % 4 == 0) return c[0];
    if (i % 4 == 1) return c[0] + u * (c[1] - c[0]);
    if (i % 4 == 2) u = depth * u;
    return c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
}

// A medium with a mean free path of 1e-12 scatters light as near as that to its faces, and none of it may be lost.
TEST(RegionTracer, ARayFromWithinAlwaysLeaves)
{
    const RegionTracer& tracer = *ball_scene().tracer().regions();
    const MediumRegion& ball = ball_scene().world().regions[0];
    V3d middle(0);
    for (const V3f& p : ball.positions) middle += V3d(p) / static_cast<double>(ball.positions.size());
    Sampler sampler(11, 0, 0, 0);
    for (int i = 0; i < 400000; ++i) {
        const double depth = std::pow(10.0, -12 * sampler.next());
        const V3d on =
            place_on(corners_of(ball, static_cast<size_t>(sampler.next() * static_cast<double>(ball.triangles.size()))),
                     sampler, i, depth);
        const V3d o = on + depth * (middle - on), d = random_direction(sampler);
        Crossing first, second;
        RegionSet regions = 1;
        ASSERT_EQ(tracer.inside(o, d), 1u) << "from " << o << " along " << d << ", " << depth << " deep";
        ASSERT_TRUE(tracer.next(o, d, 0, infinity, nullptr, regions, first))
            << "from " << o << " along " << d << ", " << depth << " deep";
        ASSERT_FALSE(first.enters) << "from " << o << " along " << d << ", " << depth << " deep";
        regions = RegionTracer::after(regions, first);
        ASSERT_FALSE(tracer.next(o, d, first.t, infinity, &first, regions, second))
            << "from " << o << " along " << d << ", " << depth << " deep";
    }
}

// Rounding may put a corner on either side of the ray, but on the same side for all triangles that share it.
TEST(RegionTracer, ARayFromOutsideEntersAndLeavesInTurn)
{
    const RegionTracer& tracer = *ball_scene().tracer().regions();
    const MediumRegion& ball = ball_scene().world().regions[0];
    Sampler sampler(12, 0, 0, 0);
    int met = 0;
    for (int i = 0; i < 400000; ++i) {
        const V3d d = random_direction(sampler);
        const auto c =
            corners_of(ball, static_cast<size_t>(sampler.next() * static_cast<double>(ball.triangles.size())));
        const V3d beside = std::pow(10.0, -3 - 6 * sampler.next()) *
                           random_direction(sampler); // a ray that only touches a corner may hit or miss
        const V3d o = place_on(c, sampler, i, 1e-7) + beside - 3 * std::pow(10.0, 2 * sampler.next()) * d;
        RegionSet regions = 0, known = 0;
        Crossing crossing;
        const Crossing* last = nullptr;
        for (double t = 0; tracer.next(o, d, t, infinity, last, regions, crossing); t = crossing.t, last = &crossing) {
            ASSERT_EQ(regions, known) << "from " << o << " along " << d;
            ASSERT_NE(crossing.enters, regions != 0) << "from " << o << " along " << d;
            known = regions = RegionTracer::after(regions, crossing);
            ++met;
        }
        ASSERT_EQ(known, 0u) << "from " << o << " along " << d;
    }
    EXPECT_GT(met, 600000); // most of these rays cross the surface
}

// Through edges, corners and the diagonals of faces, exactly.
TEST(RegionTracer, RaysAlongTheAxesOfACubeEnterAndLeaveOnce)
{
    const std::unique_ptr<TestScene> scene = scene_of(cube());
    const RegionTracer& tracer = *scene->tracer().regions();
    const double half = scene->world().regions[0].bounds().max.x;
    for (int axis = 0; axis < 3; ++axis)
        for (const double way : {-1.0, 1.0})
            for (int i = -4; i <= 4; ++i)
                for (int j = -4; j <= 4; ++j) {
                    V3d o, d(0);
                    d[axis] = way;
                    o[axis] = -3 * way * half;
                    o[(axis + 1) % 3] = i * 0.25 * half;
                    o[(axis + 2) % 3] = j * 0.25 * half;
                    RegionSet regions = 0;
                    Crossing first, second;
                    const bool is_on_rim = std::max(std::abs(i), std::abs(j)) == 4;
                    const bool enters = tracer.next(o, d, 0, infinity, nullptr, regions, first);
                    if (!enters && is_on_rim) continue; // the ray may miss
                    ASSERT_TRUE(enters && first.enters && regions == 0) << o << " along " << d;
                    ASSERT_EQ(tracer.inside(o + 3 * half * d, d), 1u) << o << " along " << d;
                    EXPECT_EQ(tracer.after(0, o, o + 3 * half * d), 1u);
                    EXPECT_EQ(tracer.after(0, o, o + 6 * half * d), 0u);
                    regions = RegionTracer::after(regions, first);
                    ASSERT_TRUE(tracer.next(o, d, first.t, infinity, &first, regions, second) && !second.enters &&
                                regions == 1)
                        << o << " along " << d;
                    EXPECT_EQ(first.t, 2 * half);
                    EXPECT_EQ(second.t, 4 * half);
                    regions = 0;
                    EXPECT_FALSE(tracer.next(o, d, second.t, infinity, &second, regions, first));
                    EXPECT_EQ(regions, 0u);
                }
}

// The crossing of a ray that starts very far away is decided near the surface.
TEST(RegionTracer, MeetsTrianglesFromFarAway)
{
    const RegionTracer& tracer = *ball_scene().tracer().regions();
    const MediumRegion& ball = ball_scene().world().regions[0];
    Sampler sampler(13, 0, 0, 0);
    for (int i = 0; i < 20000; ++i) {
        const V3d d = random_direction(sampler);
        const auto c =
            corners_of(ball, static_cast<size_t>(sampler.next() * static_cast<double>(ball.triangles.size())));
        const V3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
        if (normal.dot(d) > -0.1) continue;
        const double away = std::pow(10.0, 2 + 7 * sampler.next());
        RegionSet regions = 0;
        Crossing crossing;
        ASSERT_TRUE(tracer.next((c[0] + c[1] + c[2]) / 3 - away * d, d, 0, infinity, nullptr, regions, crossing))
            << away;
        ASSERT_TRUE(crossing.enters);
        ASSERT_NEAR(crossing.t, away, 1e-14 * away) << "the nearest face must be found, and no other in front of it";
    }
}

// Impossible regions are corrected by the crossings ahead, however far away these are.
TEST(RegionTracer, MendsRegions)
{
    const RegionTracer& tracer = *ball_scene().tracer().regions();
    const V3d middle = ball_scene().world().regions[0].bounds().center(), d(0, 0, 1);
    Crossing crossing;
    RegionSet regions = 0;
    EXPECT_TRUE(tracer.next(middle, d, 0, infinity, nullptr, regions, crossing));
    EXPECT_EQ(regions, 1u);
    regions = 1;
    EXPECT_FALSE(tracer.next(middle - 100.0 * d, d, 0, 1, nullptr, regions, crossing)) << "nothing before 1";
    EXPECT_EQ(regions, 0u);
    regions = 1;
    EXPECT_FALSE(tracer.next(middle + 100.0 * d, d, 0, 1, nullptr, regions, crossing));
    EXPECT_EQ(regions, 0u);
}

} // namespace
} // namespace scree
