// SurfaceCells against Domain, which other tests compare with exact arithmetic. The number of balls in each solid is
// SCREE_SPHERES (environment) or 20,000.

#include "packing/solids/surface_cells.h"

#include "base/hash.h"
#include "packing/solids/surface_tree.h"
#include "tests/builders/shapes.h"
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

double number(uint64_t index, uint64_t stream, double lo = 0, double hi = 1)
{
    return lo + (hi - lo) * unit_double(hash_index(index, 9, stream));
}

/// A quarter of the balls is anywhere in the bounds; the others start near a triangle, some on its edges and corners. A
/// third of these has the radius that just fits, or one within two units in the last place of it.
Ball random_ball(const Domain& domain, double largest, uint64_t k)
{
    const Imath::Box3d& bounds = domain.bounds();
    const V3d size = bounds.size();
    const double radius = largest * std::pow(10, number(k, 0, -2, 0));
    if (k % 4 == 0) return {bounds.min + V3d(number(k, 1), number(k, 2), number(k, 3)) * size, radius};
    const TriangleMesh& mesh = domain.mesh();
    const auto& t = mesh.triangles[hash_index(k, 9, 4) % mesh.triangles.size()];
    double a = number(k, 5), b = number(k, 6) * (1 - a);
    const double snap = number(k, 7);
    if (snap < 0.2) b = 0;
    if (snap < 0.1) a = 0;
    const V3d on = mesh.positions[t[0]] + (mesh.positions[t[1]] - mesh.positions[t[0]]) * a +
                   (mesh.positions[t[2]] - mesh.positions[t[0]]) * b;
    const V3d off(number(k, 8, -1, 1), number(k, 9, -1, 1), number(k, 10, -1, 1));
    const V3d centre = on + off * (largest * std::pow(10, number(k, 11, -3, 0.5)));
    if (k % 4 != 1) return {centre, radius};
    double fits = domain.distance(centre);
    for (uint64_t n = hash_index(k, 9, 12) % 5; n != 2; n += n < 2 ? 1 : -1)
        fits = std::nextafter(fits, n < 2 ? HUGE_VAL : 0);
    return {centre, fits > 0 && fits <= largest ? fits : radius};
}

/// Returns the number of balls that needed the domain's answer, minus the number of balls that just fit.
int64_t compare(const TriangleMesh& mesh, double largest)
{
    const Domain domain(mesh, "solid");
    const double size = (domain.bounds().max - domain.bounds().min).length();
    const SurfaceCells cells(domain, largest * size);
    const char* words = std::getenv("SCREE_SPHERES");
    const uint64_t count = words ? std::strtoull(words, nullptr, 10) : 20'000;
    std::atomic<uint64_t> inside = 0, wrong = 0, fitting = 0;
    tbb::parallel_for(uint64_t{0}, count, [&](uint64_t k) {
        const Ball ball = random_ball(domain, largest * size, k);
        fitting += k % 4 == 1;
        const bool answer = domain.contains_sphere(ball.centre, ball.radius);
        inside += answer;
        if (cells.contains_sphere(ball.centre, ball.radius) == answer) return;
        if (wrong++ < 5)
            ADD_FAILURE() << "ball " << k << " at " << ball.centre << " radius " << ball.radius << ": not " << answer;
    });
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(inside, count / 20);
    EXPECT_LT(inside, count - count / 20);
    return static_cast<int64_t>(cells.domain_tests()) - static_cast<int64_t>(fitting);
}

} // namespace

// If triangles are about as large as the cells, the domain is hardly ever asked.
TEST(SurfaceCells, Sphere) { EXPECT_LE(compare(icosphere(5), 0.002), 0); }
TEST(SurfaceCells, Torus) { compare(torus(1, 0.4, 120, 60), 0.003); }
TEST(SurfaceCells, CoarseTorus) { compare(torus(1, 0.4, 12, 6), 0.01); }
// Acute edges and corners, where normals of neighbours differ most.
TEST(SurfaceCells, Box) { EXPECT_LE(compare(box_mesh({-1, -0.5, -0.125}, {1, 0.75, 2}), 0.01), 0); }
TEST(SurfaceCells, Needle)
{
    compare({{{0, 0, 0}, {1, 0, 0}, {0.5, 0.05, 0}, {0.5, 0.01, 8}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}},
            0.001);
}
TEST(SurfaceCells, ThinDoubleWalledShell) { compare(double_walled_shell(4, 0.01), 0.002); }
TEST(SurfaceCells, OpenWorkedCsgShape) { compare(bored_cube(40), 0.004); }
TEST(SurfaceCells, PiecesThatTouch)
{
    const TriangleMesh cube = box_mesh(V3d(0), V3d(4));
    compare(joined(cube, moved(cube, {4, 4, 4})), 0.01);
    compare(joined(cube, moved(cube, {4, 4, 0})), 0.01);
    compare(joined(cube, flipped(box_mesh(V3d(1), V3d(3)))), 0.01);
}
// The domain answers if cells would hold too many triangles, or if the balls are too large for any cell.
TEST(SurfaceCells, BallsThatAreLargeBesideTheTriangles) { compare(icosphere(6), 0.05); }
TEST(SurfaceCells, BallsThatAreLargeBesideTheSolid) { compare(icosphere(3), 0.4); }

TEST(SurfaceCells, FarFromTheOrigin)
{
    for (const double far : {0x1p10, 0x1p24, 0x1p40}) {
        const TriangleMesh cube = joined(box_mesh(V3d(-100), V3d(100)), flipped(box_mesh(V3d(-10), V3d(10))));
        compare(moved(cube, V3d(far, -far, 2 * far)), 0.01);
    }
}

TEST(SurfaceCells, ScalingByPowersOfTwoChangesNothing)
{
    const TriangleMesh mesh = torus(1, 0.4, 36, 20);
    const Domain domain(mesh, "torus");
    const double largest = 0.01;
    const SurfaceCells cells(domain, largest);
    for (const int exponent : {-1030, -900, -60, 60, 900, 1000}) {
        const double scale = std::ldexp(1.0, exponent);
        const Domain other(scaled(mesh, scale), "scaled torus");
        const SurfaceCells scaled_cells(other, largest * scale);
        // Below the normal numbers, scaled places are rounded.
        for (uint64_t k = 0; k < 3000; ++k) {
            const Ball ball = random_ball(domain, largest, k);
            const bool expected = exponent == -1030 ? other.contains_sphere(ball.centre * scale, ball.radius * scale)
                                                    : cells.contains_sphere(ball.centre, ball.radius);
            ASSERT_EQ(scaled_cells.contains_sphere(ball.centre * scale, ball.radius * scale), expected)
                << k << " at 2^" << exponent;
        }
    }
}
