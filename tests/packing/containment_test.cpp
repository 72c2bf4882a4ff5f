// Domain::contains_sphere against all triangles in exact arithmetic. The number of balls in each solid is SCREE_SPHERES
// (environment) or 10,000; the slow run has 1,000,000.

#include "base/hash.h"
#include "packing/solids/domain.h"
#include "tests/builders/shapes.h"
#include "tests/packing/exact_containment.h"
#include "tests/packing/solids.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>

using namespace scree;
using Imath::V3d;

namespace {

struct Ball {
    V3d centre;
    double radius;
};

/// A stream of random numbers for one ball.
class Numbers {
public:
    explicit Numbers(uint64_t index) : index_(index) {}
    uint64_t bits() { return hash_index(index_, 7, stream_++); }
    double unit() { return unit_double(bits()); }
    double between(double lo, double hi) { return lo + (hi - lo) * unit(); }

private:
    uint64_t index_, stream_ = 0;
};

double moved_by_units(double x, int units)
{
    for (; units > 0; --units) x = std::nextafter(x, HUGE_VAL);
    for (; units < 0; ++units) x = std::nextafter(x, 0);
    return x;
}

/// Half of the balls are anywhere, with radii over four decades. A quarter is near a triangle, some exactly on it. A
/// quarter has the radius that just fits, or one within two units in the last place of it.
Ball random_ball(const TriangleMesh& mesh, const Domain& domain, uint64_t index)
{
    Numbers u(index);
    const auto& [lo, hi] = domain.bounds();
    const double size = (hi - lo).length();
    const uint64_t kind = u.bits() % 4;
    if (kind == 0) {
        const auto& t = mesh.triangles[u.bits() % mesh.triangles.size()];
        const double a = u.unit(), b = u.unit() * (1 - a);
        // Weights of 0 and 1 put the place on edges and corners.
        const double snap = u.unit();
        const double wa = snap < 0.2 ? 0 : snap < 0.3 ? 1 : a, wb = snap < 0.25 ? 0 : snap < 0.3 ? 0 : b;
        const V3d p = mesh.positions[t[0]] + (mesh.positions[t[1]] - mesh.positions[t[0]]) * wa +
                      (mesh.positions[t[2]] - mesh.positions[t[0]]) * wb;
        const double off = u.unit() < 0.3 ? 0 : size * std::pow(10, u.between(-15, -1));
        const V3d centre = p + V3d(u.between(-1, 1), u.between(-1, 1), u.between(-1, 1)) * off;
        return {centre, u.unit() < 0.2 ? 0 : off * std::pow(10, u.between(-2, 1))};
    }
    const V3d margin = (hi - lo) * 0.05;
    V3d centre;
    for (int k = 0; k < 3; ++k) centre[k] = u.between(lo[k] - margin[k], hi[k] + margin[k]);
    if (kind == 1) return {centre, moved_by_units(domain.distance(centre), static_cast<int>(u.bits() % 5) - 2)};
    return {centre, size * std::pow(10, u.between(-4, 0))};
}

uint64_t sphere_count()
{
    const char* words = std::getenv("SCREE_SPHERES");
    return words ? std::strtoull(words, nullptr, 10) : 10'000;
}

void compare_with_all_triangles(const TriangleMesh& mesh)
{
    const Domain domain(mesh, "solid");
    const ExactSolid truth(mesh);
    std::atomic<uint64_t> inside = 0, wrong = 0;
    const uint64_t count = sphere_count();
    tbb::parallel_for(uint64_t{0}, count, [&](uint64_t k) {
        const Ball ball = random_ball(mesh, domain, k);
        const bool answer = domain.contains_sphere(ball.centre, ball.radius);
        inside += answer;
        if (answer == truth.contains_sphere(ball.centre, ball.radius)) return;
        if (wrong++ < 5)
            ADD_FAILURE() << "ball " << k << " at " << ball.centre << " radius " << ball.radius << ": " << answer;
    });
    EXPECT_EQ(wrong, 0u);
    // Both answers must occur often, or the test shows little.
    EXPECT_GT(inside, count / 100);
    EXPECT_LT(inside, count - count / 10);
    testing::Test::RecordProperty("inside", std::to_string(inside));
}

/// A cube of edge 200 with a cubic cavity of edge 20 in its middle.
TriangleMesh hollow_cube() { return joined(box_mesh(V3d(-100), V3d(100)), flipped(box_mesh(V3d(-10), V3d(10)))); }

/// Balls in the hollow cube that touch a face, an edge or a corner of the cavity, or an outer face; all coordinates are
/// integers.
const std::vector<Ball> touching = {{{17, 0, 0}, 7},     {{13, 14, 0}, 5}, {{12, 13, 16}, 7},
                                    {{-12, 16, -13}, 7}, {{60, 0, 0}, 40}, {{15, -22, 3}, 13}};

} // namespace

TEST(Containment, Sphere) { compare_with_all_triangles(icosphere(3)); }
TEST(Containment, Torus) { compare_with_all_triangles(torus(1, 0.4, 36, 20)); }
TEST(Containment, SharpBox) { compare_with_all_triangles(box_mesh({-1, -0.5, -0.125}, {1, 0.75, 2})); }
TEST(Containment, ThinDoubleWalledShell) { compare_with_all_triangles(double_walled_shell(2, 0.01)); }
TEST(Containment, OpenWorkedCsgShape) { compare_with_all_triangles(bored_cube(14)); }

TEST(Containment, TouchingIsInsideAndOneUnitMoreIsNot)
{
    // Powers of two up to where squares overflow or vanish and coordinates become subnormal; then far from the origin.
    for (const int exponent : {0, 60, -60, 900, -900, 1000, -1030}) {
        const double scale = std::ldexp(1.0, exponent);
        const Domain domain(scaled(hollow_cube(), scale), "hollow cube");
        for (const Ball& ball : touching) {
            const V3d centre = ball.centre * scale;
            const double r = ball.radius * scale;
            EXPECT_TRUE(domain.contains_sphere(centre, r)) << ball.centre << " at 2^" << exponent;
            EXPECT_FALSE(domain.contains_sphere(centre, std::nextafter(r, HUGE_VAL)))
                << ball.centre << " at 2^" << exponent;
            EXPECT_TRUE(domain.contains_sphere(centre, std::nextafter(r, 0)));
        }
    }
    const V3d far(0x1p40, -0x1p41, 0x1p42);
    const Domain domain(moved(hollow_cube(), far), "far hollow cube");
    for (const Ball& ball : touching) {
        EXPECT_TRUE(domain.contains_sphere(ball.centre + far, ball.radius));
        EXPECT_FALSE(domain.contains_sphere(ball.centre + far, std::nextafter(ball.radius, 100)));
    }
}

TEST(Containment, PointsOfTheSurfaceAreNotInside)
{
    const TriangleMesh mesh = hollow_cube();
    const Domain domain(mesh, "hollow cube");
    for (const V3d& p : mesh.positions) EXPECT_FALSE(domain.contains(p)) << p;
    for (const V3d& p :
         {V3d(10, 3, 10), V3d(-10, 10, 0), V3d(0, 0, 100), V3d(5, 5, 10), V3d(100, 100, 0), V3d(-100, 0.3, 0.7)}) {
        EXPECT_FALSE(domain.contains(p)) << p;
        EXPECT_FALSE(domain.contains_sphere(p, 1e-300)) << p;
    }
    EXPECT_FALSE(domain.contains({0, 0, 0})); // in the cavity
    EXPECT_FALSE(domain.contains({0, 0, std::nextafter(10.0, 0)})); // one unit below the cavity's upper face
    EXPECT_TRUE(domain.contains({0, 0, std::nextafter(10.0, 11)})); // one unit above
    EXPECT_TRUE(domain.contains_sphere({0, 0, std::nextafter(10.0, 11)}, 0x1p-49));
    EXPECT_FALSE(domain.contains_sphere({0, 0, std::nextafter(10.0, 11)}, 0x1.8p-49));
}

TEST(Containment, WhatIsNoBallIsNotInside)
{
    const Domain domain(box_mesh(V3d(-1), V3d(1)), "cube");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(domain.contains_sphere(V3d(0), 0));
    EXPECT_TRUE(domain.contains_sphere(V3d(0), 1));
    EXPECT_FALSE(domain.contains_sphere(V3d(0), -1));
    EXPECT_FALSE(domain.contains_sphere(V3d(0), nan));
    EXPECT_FALSE(domain.contains_sphere(V3d(0), HUGE_VAL));
    EXPECT_FALSE(domain.contains_sphere(V3d(0, nan, 0), 0.5));
    EXPECT_FALSE(domain.contains_sphere(V3d(HUGE_VAL, 0, 0), 0.5));
    EXPECT_FALSE(domain.contains_sphere(V3d(1e300, 0, 0), 1e300));
    EXPECT_FALSE(domain.contains_sphere(V3d(0, 0, 1e300), 0));
}

// The rays that count crossings go straight up: through corners and along edges, where counting goes wrong most easily.
TEST(Containment, RaysThroughCornersAndEdges)
{
    const TriangleMesh octahedron = {
        {{8, 0, 0}, {-8, 0, 0}, {0, 8, 0}, {0, -8, 0}, {0, 0, 8}, {0, 0, -8}},
        {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    const TriangleMesh hollow = joined(octahedron, flipped(scaled(octahedron, 0.5)));
    const Domain solid(octahedron, "octahedron"), shell(hollow, "hollow octahedron"),
        cube(box_mesh(V3d(-4), V3d(4)), "cube");
    for (int x = -9; x <= 9; ++x)
        for (int y = -9; y <= 9; ++y)
            for (int z = -9; z <= 9; ++z) {
                const int sum = std::abs(x) + std::abs(y) + std::abs(z);
                EXPECT_EQ(solid.contains(V3d(x, y, z)), sum < 8) << x << ' ' << y << ' ' << z;
                EXPECT_EQ(shell.contains(V3d(x, y, z)), sum < 8 && sum > 4) << x << ' ' << y << ' ' << z;
                EXPECT_EQ(cube.contains(V3d(x, y, z)), std::max({std::abs(x), std::abs(y), std::abs(z)}) < 4)
                    << x << ' ' << y << ' ' << z;
            }
}

TEST(Containment, ScalingByPowersOfTwoChangesNothing)
{
    const TriangleMesh mesh = torus(1, 0.4, 24, 12);
    const Domain domain(mesh, "torus");
    for (const int exponent : {60, -60, 900, -900}) {
        const double scale = std::ldexp(1.0, exponent);
        const Domain other(scaled(mesh, scale), "scaled torus");
        for (uint64_t k = 0; k < 3000; ++k) {
            const Ball ball = random_ball(mesh, domain, k);
            ASSERT_EQ(domain.contains_sphere(ball.centre, ball.radius),
                      other.contains_sphere(ball.centre * scale, ball.radius * scale))
                << k;
        }
    }
}
