#include "packing/solids/distance_field.h"

#include "base/error.h"
#include "base/hash.h"
#include "tests/builders/shapes.h"
#include "tests/packing/solids.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>

using namespace scree;
using Imath::V3d;

namespace {

V3d random_place(const Imath::Box3d& box, double margin, uint64_t index)
{
    const V3d size = box.size() * (1 + 2 * margin);
    const V3d u(unit_double(hash_index(index, 5, 0)), unit_double(hash_index(index, 5, 1)),
                unit_double(hash_index(index, 5, 2)));
    return box.min - box.size() * margin + u * size;
}

/// A place near the surface: a random point of a random face, moved off it by a random part of `reach`.
V3d place_near_surface(const TriangleMesh& mesh, double reach, uint64_t index)
{
    const auto number = [&](uint64_t stream) { return unit_double(hash_index(index, 6, stream)); };
    const auto& t = mesh.triangles[hash_index(index, 6, 9) % mesh.triangles.size()];
    const double u = number(0), v = number(1) * (1 - u);
    const V3d& a = mesh.positions[t[0]];
    const double off = reach * std::pow(10, -6 * number(2));
    return a + (mesh.positions[t[1]] - a) * u + (mesh.positions[t[2]] - a) * v +
           (V3d(number(3), number(4), number(5)) - V3d(0.5)) * off;
}

/// The interval contains the truth everywhere. If `narrow`, within two voxels of the surface it is also no wider than
/// a voxel's diagonal.
void expect_right(const TriangleMesh& mesh, int cells, uint64_t count, bool narrow = true)
{
    const Domain domain(mesh, "solid");
    const DistanceField field(domain, cells);
    const V3d size = domain.bounds().size();
    const double voxel = std::max({size.x, size.y, size.z}) / cells;
    std::atomic<uint64_t> wrong = 0, wide = 0, near = 0;
    tbb::parallel_for(uint64_t{0}, count, [&](uint64_t k) {
        const V3d p = k % 2 ? random_place(domain.bounds(), 0.1, k) : place_near_surface(mesh, 6 * voxel, k);
        const DistanceField::Interval d = field.signed_distance(p);
        const double unsigned_truth = domain.distance(p), truth = domain.contains(p) ? unsigned_truth : -unsigned_truth;
        // The truth itself has a rounding error.
        const double rounding = 4e-14 * size.length();
        if (!(truth >= d.lo - rounding && truth <= d.hi + rounding) && wrong++ < 5) {
            ADD_FAILURE() << "at " << p << ": " << truth << " is not in " << d.lo << " .. " << d.hi;
        }
        if (unsigned_truth > 1.5 * voxel) return;
        ++near;
        // Half a voxel's diagonal on each side.
        wide += !(d.hi - d.lo <= 2 * std::sqrt(0.75) * voxel * (1 + 1e-5));
    });
    EXPECT_EQ(wrong, 0u);
    if (narrow) {
        EXPECT_EQ(wide, 0u);
    }
    EXPECT_GT(near, count / 20);
}

} // namespace

TEST(DistanceField, IsNeverWrong)
{
    expect_right(icosphere(3), 64, 50'000);
    expect_right(torus(1, 0.4, 48, 24), 100, 30'000);
    expect_right(box_mesh({-1, -0.5, -0.125}, {1, 0.75, 2}), 50, 50'000);
    expect_right(bored_cube(24), 90, 50'000);
}

TEST(DistanceField, IsNeverWrongAtWallsThinnerThanAVoxel)
{
    expect_right(double_walled_shell(3, 0.01), 64, 50'000);
    expect_right(double_walled_shell(2, 1e-5), 64, 50'000);
    expect_right(joined(box_mesh(V3d(0), V3d(1, 1, 1e-3)), box_mesh(V3d(0, 0, 0.002), V3d(1, 1, 0.003))), 40, 50'000);
}

TEST(DistanceField, AnyScaleAndPlaceWillDo)
{
    const TriangleMesh mesh = torus(1, 0.4, 24, 12);
    for (const double scale : {0x1p-900, 0x1p-60, 0x1p60, 0x1p900}) expect_right(scaled(mesh, scale), 40, 4000);
    expect_right(moved(mesh, {1e7, -1e6, 1e5}), 40, 20'000);
    // So far from the origin that neighbouring doubles differ by a hundredth of the size.
    expect_right(moved(box_mesh(V3d(0), V3d(64)), {0x1p52, 0x1p52, 0}), 30, 4000, false);
}

TEST(DistanceField, FewCellsAreRoughAndRight)
{
    for (const int cells : {1, 2, 5, 8, 9}) expect_right(bored_cube(16), cells, 10'000);
}

TEST(DistanceField, TellsTheSignAwayFromTheSurface)
{
    const Domain domain(icosphere(4), "sphere");
    const DistanceField field(domain, 64);
    EXPECT_GT(field.signed_distance(V3d(0)).lo, 0.6); // a lower bound for a whole block
    EXPECT_GT(field.signed_distance(V3d(0.9, 0, 0)).lo, 0);
    EXPECT_LT(field.signed_distance(V3d(1.1, 0, 0)).hi, 0);
    // Outside the lattice the bounds of the domain give the distance.
    EXPECT_NEAR(field.signed_distance(V3d(11, 0, 0)).hi, -10, 0.01);
    EXPECT_LE(field.signed_distance(V3d(0, 0, -1e300)).hi, -1e299);
    EXPECT_LE(field.signed_distance(V3d(0, HUGE_VAL, 0)).hi, 0);
    const DistanceField::Interval nothing = field.signed_distance(V3d(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_EQ(nothing.lo, -HUGE_VAL);
    EXPECT_EQ(nothing.hi, HUGE_VAL);
}

TEST(DistanceField, RefusesSenselessCells)
{
    const Domain domain(box_mesh(V3d(0), V3d(1)), "cube");
    EXPECT_THROW(DistanceField(domain, 0), InputError);
    EXPECT_THROW(DistanceField(domain, 1 << 20), InputError);
}
