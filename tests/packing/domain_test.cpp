#include "packing/solids/domain.h"

#include "base/hash.h"
#include "packing/solids/exact_distance.h"
#include "packing/solids/surface_tree.h"
#include "tests/builders/shapes.h"
#include "tests/packing/exact_containment.h"
#include "tests/packing/solids.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <numbers>

using namespace scree;
using Imath::V3d;

namespace {

double number(uint64_t index, uint64_t stream, double lo = 0, double hi = 1)
{
    return lo + (hi - lo) * unit_double(hash_index(index, 3, stream));
}

V3d place_in(const Imath::Box3d& box, uint64_t index)
{
    const V3d size = box.size();
    return box.min + V3d(number(index, 0), number(index, 1), number(index, 2)) * size;
}

void expect_solid(const TriangleMesh& mesh, double volume)
{
    const std::vector<MeshDefect> defects = find_defects(mesh);
    ASSERT_TRUE(defects.empty()) << defects[0].found;
    EXPECT_NEAR(Domain(mesh, "solid").volume(), volume, 1e-12 * volume);
}

} // namespace

TEST(Domain, AcceptsCavitiesIslandsAndSeveralPieces)
{
    const TriangleMesh cube = box_mesh(V3d(0), V3d(4)), small = box_mesh(V3d(1), V3d(3)),
                       smaller = box_mesh(V3d(1.5), V3d(2.5));
    expect_solid(cube, 64);
    expect_solid(joined(cube, flipped(small)), 56);
    expect_solid(joined(joined(cube, flipped(small)), smaller), 57);
    expect_solid(joined(flipped(small), joined(smaller, cube)), 57);
    expect_solid(joined(cube, moved(cube, {5, 0, 0})), 128);
    // Pieces that touch at a corner or along an edge, each with its own vertices, do not overlap.
    expect_solid(joined(cube, moved(cube, {4, 4, 4})), 128);
    expect_solid(joined(cube, moved(cube, {4, 4, 0})), 128);
}

TEST(Domain, UnusedVerticesAndHugeCoordinatesAreNoDefects)
{
    TriangleMesh mesh = box_mesh(V3d(0), V3d(1));
    mesh.positions.emplace_back(std::numeric_limits<double>::quiet_NaN());
    const Domain domain(mesh, "cube");
    EXPECT_EQ(domain.bounds().max, V3d(1));
    EXPECT_EQ(domain.volume(), 1);
    EXPECT_TRUE(domain.contains(V3d(0.5)));

    EXPECT_EQ(Domain(box_mesh(V3d(-1e300), V3d(1e300)), "huge").volume(), HUGE_VAL); // 8e900 is no double
    EXPECT_NEAR(Domain(box_mesh(V3d(-1e100), V3d(1e100)), "large").volume() / 8e300, 1, 1e-14);
    mesh.positions[7] = V3d(1e300);
    const Domain spike(mesh, "spike");
    EXPECT_TRUE(spike.contains(V3d(1e299)));
    EXPECT_FALSE(spike.contains(V3d(1e299, 1e299, 2e299)));
}

TEST(Domain, ThinWallsKeepTheirVolume)
{
    // The shell's volume is that of the ball times 1 - (1 - t)^3.
    const double t = 1e-6, ball = Domain(icosphere(3), "ball").volume();
    EXPECT_NEAR(Domain(double_walled_shell(3, t), "shell").volume() / (ball * (1 - std::pow(1 - t, 3))), 1, 1e-9);
    // The volume of a torus is 2 pi^2 R r^2.
    const double pi = std::numbers::pi;
    EXPECT_NEAR(Domain(torus(2, 0.5, 400, 200), "torus").volume(), 2 * pi * pi * 2 * 0.25, 0.003);
}

TEST(Domain, CsgOfLevelSetsIsASolid)
{
    for (const int cells : {14, 31, 60}) EXPECT_TRUE(find_defects(bored_cube(cells)).empty()) << cells;
}

TEST(Domain, DistanceIsRightTo1e14OfTheBounds)
{
    const Imath::Box3d around(V3d(-2), V3d(2));
    for (const TriangleMesh& mesh :
         {icosphere(2), torus(1, 0.3, 20, 12), double_walled_shell(1, 1e-5), bored_cube(10)}) {
        const Domain domain(mesh, "solid");
        const ExactSolid truth(mesh);
        for (uint64_t k = 0; k < 400; ++k) {
            const V3d p = place_in(k % 2 ? around : domain.bounds(), k);
            EXPECT_NEAR(domain.distance(p), truth.distance(p), 4e-14) << p;
        }
        for (const V3d& p : mesh.positions) EXPECT_LE(domain.distance(p), 1e-14);
    }
}

TEST(Domain, DistanceToSliversIsExactToo)
{
    // A cone of needles 1e-9 wide.
    TriangleMesh cone{{{0, 0, 0}, {0, 0, 1}}, {}};
    const uint32_t n = 16;
    for (uint32_t k = 0; k < n; ++k)
        cone.positions.emplace_back(1e-9 * std::cos(2 * M_PI * k / n), 1e-9 * std::sin(2 * M_PI * k / n), 0);
    for (uint32_t k = 0; k < n; ++k) {
        cone.triangles.push_back({0, 2 + (k + 1) % n, 2 + k});
        cone.triangles.push_back({1, 2 + k, 2 + (k + 1) % n});
    }
    const Domain domain(cone, "needle");
    const ExactSolid truth(cone);
    for (uint64_t k = 0; k < 300; ++k) {
        const double reach = std::pow(10, number(k, 5, -11, 0));
        const V3d p(number(k, 0, -reach, reach), number(k, 1, -reach, reach), number(k, 2, -0.5, 1.5));
        const double d = truth.distance(p);
        EXPECT_NEAR(domain.distance(p), d, 2e-14) << p;
    }
}

TEST(Domain, ManyThreadsGetTheAnswersOfOne)
{
    const Domain domain(bored_cube(20), "bored cube");
    const size_t n = 20'000;
    std::vector<double> one(n), many(n);
    const auto ask = [&](size_t k) {
        const V3d p = place_in(domain.bounds(), k);
        return domain.contains_sphere(p, 0.02) ? -domain.distance(p) : domain.distance(p);
    };
    for (size_t k = 0; k < n; ++k) one[k] = ask(k);
    tbb::parallel_for(size_t{0}, n, [&](size_t k) { many[k] = ask(k); });
    EXPECT_EQ(one, many);
}

// Triangles of all shapes, down to needles of width 1e-12 of their length, at distances of all sizes: the truth is
// always within the bounds.
TEST(ExactDistance, BoundsHoldTheTruth)
{
    for (uint64_t k = 0; k < 8000; ++k) {
        const double thin = std::pow(10, number(k, 0, -12, 0)), far = std::pow(10, number(k, 1, -8, 0));
        uint64_t stream = 2;
        const auto draw = [&] {
            return V3d(number(k, stream, -1, 1), number(k, stream + 1, -1, 1), number(k, stream + 2, -1, 1));
        };
        const V3d a = draw();
        stream += 3;
        const V3d b = a + draw();
        stream += 3;
        const double t = number(k, 30, -0.5, 1.5);
        const V3d c = a + (b - a) * t + draw() * thin;
        stream += 3;
        const double u = number(k, 31), v = number(k, 32, 0, 1 - u);
        const V3d p = a + (b - a) * u + (c - a) * v + draw() * (k % 10 == 0 ? 0 : far);
        const DistanceBounds d = bound_distance(p, {a, b, c}, 0.25);
        EXPECT_LE(d.lo, d.hi);
        // 4 lo and 4 hi are not rounded: 4 is a power of two.
        EXPECT_GE(compare_distance(p, a, b, c, 4 * d.lo), 0) << k;
        EXPECT_LE(compare_distance(p, a, b, c, 4 * d.hi), 0) << k;
        // Rounding tilts the direction of a needle's plane by a few units times length over height, and the direction
        // of a short distance by a few units times length over distance.
        const double length = std::max({(b - a).length(), (c - b).length(), (a - c).length()});
        const double height = (b - a).cross(c - a).length() / length;
        const double reach = std::max({(a - p).length(), (b - p).length(), (c - p).length()});
        if (d.lo > 0 &&
            height > 1e-4 * length) { // rounding may choose a wrong direction for needles: left to exact arithmetic
            EXPECT_LE(4 * (d.hi - d.lo), 0x1p-53 * reach * (80 + 64 * length / height + 64 * length / (4 * d.lo))) << k;
        }
        EXPECT_EQ(is_nearer_exactly(p, {a, b, c}, 4 * d.hi + 1e-13), true);
        EXPECT_EQ(is_nearer_exactly(p, {a, b, c}, 4 * d.lo), false);
    }
}

TEST(ExactDistance, ExactRootsAreRounded)
{
    const Corners triangle{V3d(0), V3d(4, 0, 0), V3d(0, 4, 0)};
    EXPECT_EQ(distance_exactly({1, 1, 7}, triangle), 7);
    EXPECT_EQ(distance_exactly({-3, -4, 0}, triangle), 5);
    EXPECT_EQ(distance_exactly({6, -3, 6}, triangle), 7);
    EXPECT_EQ(distance_exactly({1, -5, 12}, triangle), 13);
    EXPECT_EQ(distance_exactly({1, 1, 0}, triangle), 0);
    EXPECT_TRUE(touches_exactly({1, 1, 0}, triangle));
    EXPECT_FALSE(touches_exactly({1, 1, 1e-300}, triangle));
    EXPECT_FALSE(is_nearer_exactly({1, 1, 7}, triangle, 7));
    EXPECT_TRUE(is_nearer_exactly({1, 1, 7}, triangle, std::nextafter(7.0, 8)));
}
