#include "render/medium/clearance_field.h"

#include "ingest/support/error.h"
#include "tests/builders/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace scree {
namespace {

struct Mesh {
    std::vector<V3f> positions;
    std::vector<std::array<uint32_t, 3>> triangles;

    TriangleView view() const { return {positions, triangles}; }
};

Mesh make(const TriangleMesh& from, const V3d& scale = V3d(1), const V3d& by = V3d(0))
{
    Mesh mesh;
    for (const V3d& p : from.positions) mesh.positions.emplace_back(V3f(p * scale + by));
    mesh.triangles = from.triangles;
    return mesh;
}

double distance_to_segment(const V3d& p, const V3d& a, const V3d& b)
{
    const V3d d = b - a;
    const double t = d.length2() > 0 ? std::clamp((p - a).dot(d) / d.length2(), 0.0, 1.0) : 0;
    return (p - a - d * t).length();
}

double distance(const Mesh& mesh, const V3d& p)
{
    double least = INFINITY;
    for (const auto& t : mesh.triangles) {
        const V3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]), n = (b - a).cross(c - a);
        const double nn = n.dot(n), v = (p - a).cross(c - a).dot(n), w = (b - a).cross(p - a).dot(n);
        if (nn > 0 && v >= 0 && w >= 0 && v + w <= nn) least = std::min(least, std::abs((p - a).dot(n)) / std::sqrt(nn));
        else least = std::min({least, distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
    }
    return least;
}

/// Compares with true distances at random places in a box; the share of places where the bound is more than two voxels below.
double check(const std::vector<Mesh>& meshes, const Imath::Box3d& box, int places, int voxels = 100)
{
    std::vector<TriangleView> views;
    for (const Mesh& m : meshes) views.push_back(m.view());
    const ClearanceField field(views, box, Progress(), voxels);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform;
    int low = 0;
    double worst = 0;
    for (int i = 0; i < places; ++i) {
        const V3d p = box.min + box.size() * V3d(uniform(random), uniform(random), uniform(random));
        double truth = INFINITY;
        for (const Mesh& m : meshes) truth = std::min(truth, distance(m, p));
        const double bound = field.clearance(p);
        EXPECT_LE(bound, truth);
        low += bound < truth - 2 * field.voxel();
        worst = std::max(worst, (truth - bound) / field.voxel());
    }
    // From the place to the centre and back, half a voxel's diagonal each, and in the half voxel that is marked, or one beside it.
    EXPECT_LT(worst, 2 * std::sqrt(3.0) + 0.01);
    return static_cast<double>(low) / places;
}

Mesh random_triangles(int count, double spread, double size, uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const V3d at = V3d(normal(random), normal(random), normal(random)) * spread;
        for (int k = 0; k < 3; ++k) mesh.positions.emplace_back(V3f(at + V3d(normal(random), normal(random), normal(random)) * size));
        const auto first = static_cast<uint32_t>(3 * i);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

TEST(ClearanceField, IsNeverAboveTheDistanceAndNotFarBelow)
{
    const Imath::Box3d box(V3d(-1.1, -1.2, -1.3), V3d(1.1, 1.2, 1.3));
    EXPECT_LT(check({make(icosphere(3))}, box, 3000), 0.1);
    EXPECT_LT(check({make(cube())}, box, 20000), 0.1);
    EXPECT_LT(check({make(cube(), V3d(0.7, 0.2, 0.1)), make(icosphere(2), V3d(0.1), V3d(0.5))}, box, 5000), 0.1);
    const Imath::Box3d large(V3d(-4), V3d(4, 4.1, 4.2));
    EXPECT_LT(check({random_triangles(30, 0.6, 0.3, 2)}, large, 10000), 0.1);
    EXPECT_LT(check({random_triangles(30, 0.6, 0.01, 3)}, large, 10000), 0.1);
    EXPECT_LT(check({make(icosphere(2))}, box, 3000, 7), 0.1);
}

TEST(ClearanceField, CountsTrianglesBeyondTheBox)
{
    const Imath::Box3d box(V3d(-0.5), V3d(0.5, 0.4, 0.3));
    const Mesh triangles = random_triangles(40, 0.6, 0.3, 4);
    const std::vector<TriangleView> all{triangles.view()};
    const Imath::Box3d inner(V3d(-0.4, -0.5, -0.3), V3d(0.5, 0.3, 0.4));
    const ClearanceField cut(all, inner, Progress());
    std::mt19937_64 places(1);
    std::uniform_real_distribution<double> unit;
    for (int i = 0; i < 20000; ++i) {
        const V3d p = inner.min + inner.size() * V3d(unit(places), unit(places), unit(places));
        EXPECT_LE(cut.clearance(p), distance(triangles, p));
    }
    // What lies far beyond is seen at the box's faces: below the truth by more than voxels, never above.
    const Mesh plane = make(ground(1000, -0.6));
    const std::vector<TriangleView> view{plane.view()};
    const ClearanceField field(view, box, Progress());
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    for (int i = 0; i < 2000; ++i) {
        const V3d p(uniform(random), 0.8 * uniform(random), 0.6 * uniform(random));
        EXPECT_LE(field.clearance(p), p.z + 0.6);
        EXPECT_GE(field.clearance(p), p.z + 0.5 - 2 * field.voxel());
    }
    EXPECT_EQ(field.clearance({0.6, 0, 0}), 0);
    EXPECT_EQ(field.clearance({0, 0, -0.51}), 0);
    EXPECT_EQ(field.clearance({NAN, 0, 0}), 0);
}

TEST(ClearanceField, IsTheSameInAUnitThatIsAPowerOfTwo)
{
    const Mesh small = make(icosphere(2)), large = make(icosphere(2), V3d(0x1p20));
    const std::vector<TriangleView> a{small.view()}, b{large.view()};
    const Imath::Box3d box(V3d(-1.1), V3d(1.3, 1.2, 1.1));
    const ClearanceField fa(a, box, Progress()), fb(b, {box.min * 0x1p20, box.max * 0x1p20}, Progress());
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-1.1, 1.1);
    for (int i = 0; i < 10000; ++i) {
        const V3d p(uniform(random), uniform(random), uniform(random));
        EXPECT_EQ(fa.clearance(p) * 0x1p20, fb.clearance(p * 0x1p20));
    }
}

TEST(ClearanceField, TakesNoTrianglesFlatBoxesAndTrianglesWithoutArea)
{
    EXPECT_EQ(ClearanceField().clearance(V3d(0)), 0);
    const Imath::Box3d box(V3d(-1), V3d(1));
    const ClearanceField nothing({}, box, Progress());
    EXPECT_EQ(nothing.clearance(V3d(0.1)), INFINITY);
    EXPECT_EQ(nothing.clearance(V3d(2)), 0);
    const Mesh needle{{V3f(-0.9f, 0, 0), V3f(0.9f, 0.1f, 0.2f), V3f(-0.9f, 0, 0)}, {{0, 1, 2}}};
    EXPECT_LT(check({needle}, box, 3000), 0.1);
    const std::vector<TriangleView> view{needle.view()};
    const ClearanceField flat(view, {V3d(-1, -1, 0), V3d(1, 1, 0)}, Progress());
    EXPECT_GT(flat.clearance({0, -0.9, 0}), 0.9);
    EXPECT_LT(flat.clearance({0, -0.9, 0}), 1);
}

TEST(ClearanceField, RefusesWhatItCannotHold)
{
    const Imath::Box3d box(V3d(-1), V3d(1));
    EXPECT_THROW(ClearanceField({}, box, Progress(), 0), InputError);
    EXPECT_THROW(ClearanceField({}, Imath::Box3d(), Progress()), InputError);
    const Mesh bad{{V3f(0), V3f(NAN), V3f(1)}, {{0, 1, 2}}}, torn{{V3f(0)}, {{0, 1, 2}}};
    const std::vector<TriangleView> a{bad.view()}, b{torn.view()};
    EXPECT_THROW(ClearanceField(a, box, Progress()), InputError);
    EXPECT_THROW(ClearanceField(b, box, Progress()), InputError);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(ClearanceField(a, box, progress), Cancelled);
}

} // namespace
} // namespace scree
