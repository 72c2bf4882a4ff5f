#include "render/equivalent/core_region.h"

#include "base/error.h"
#include "ingest/meshes/triangle_mesh.h"
#include "tests/builders/packings.h"
#include "tests/builders/shapes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>
#include <random>

namespace scree {
namespace {

TriangleMesh to_mesh(const RegionSurface& surface)
{
    TriangleMesh mesh;
    for (const V3f& p : surface.positions) mesh.positions.emplace_back(p);
    mesh.triangles = surface.triangles;
    return mesh;
}

RegionSurface to_surface(const TriangleMesh& mesh, const V3d& scale = V3d(1), const V3d& by = V3d(0))
{
    RegionSurface surface;
    for (const V3d& p : mesh.positions) surface.positions.emplace_back(V3f(p * scale + by));
    surface.triangles = mesh.triangles;
    return surface;
}

RegionSurface joined(RegionSurface a, const RegionSurface& b, bool flip)
{
    const auto offset = static_cast<uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const auto& t : b.triangles)
        a.triangles.push_back({t[0] + offset, t[flip ? 2 : 1] + offset, t[flip ? 1 : 2] + offset});
    return a;
}

std::optional<RegionSurface> inset(const RegionSurface& surface, double depth)
{
    return inset_of_mesh(surface.positions, surface.triangles, depth, Progress());
}

using Spheres = std::vector<GrainStore::Sphere>;

std::optional<RegionSurface> core(const Spheres& spheres, double depth, const HeapOptions& options = {})
{
    return core_of_spheres(spheres, depth, Progress(), options);
}

/// Whether every edge has its opposite: a closed surface, perhaps with more than two faces at an edge.
bool is_balanced(const RegionSurface& surface)
{
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const auto& t : surface.triangles)
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = t[k], b = t[(k + 1) % 3];
            a < b ? ++edges[{a, b}] : --edges[{b, a}];
        }
    return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 0; });
}

double distance_to_triangle(const V3d& p, const V3d& a, const V3d& b, const V3d& c)
{
    const V3d ab = b - a, ac = c - a, n = ab.cross(ac), ap = p - a;
    const double nn = n.dot(n), v = ap.cross(ac).dot(n) / nn, w = ab.cross(ap).dot(n) / nn;
    if (nn > 0 && v >= 0 && w >= 0 && v + w <= 1) return std::abs(ap.dot(n)) / std::sqrt(nn);
    const auto segment = [&](const V3d& q, const V3d& r) {
        const V3d d = r - q;
        const double t = d.dot(d) > 0 ? std::clamp((p - q).dot(d) / d.dot(d), 0.0, 1.0) : 0;
        return (p - q - d * t).length();
    };
    return std::min({segment(a, b), segment(b, c), segment(c, a)});
}

/// Least distance of the region's vertices from a mesh; of a part of them if they are many.
double least_distance(const RegionSurface& region, const RegionSurface& mesh)
{
    double least = INFINITY;
    const size_t step = region.positions.size() * mesh.triangles.size() / 20000000 + 1;
    for (size_t i = 0; i < region.positions.size(); i += step)
        for (const auto& t : mesh.triangles)
            least = std::min(least, distance_to_triangle(V3d(region.positions[i]), V3d(mesh.positions[t[0]]),
                                                         V3d(mesh.positions[t[1]]), V3d(mesh.positions[t[2]])));
    return least;
}

TEST(InsetOfMesh, MeetsTheFacesOfABoxExactly)
{
    const RegionSurface box = to_surface(cube(), V3d(2, 1, 0.5), V3d(0.1, 0.2, 0.3));
    for (const double depth : {0.3, 0.1, 0.05}) {
        const auto region = inset(box, depth);
        ASSERT_TRUE(region);
        EXPECT_TRUE(is_closed_and_oriented(to_mesh(*region)));
        EXPECT_FALSE(region->coarsened);
        const V3d half(2 - depth, 1 - depth, 0.5 - depth);
        size_t on_faces = 0;
        for (const V3f& p : region->positions) {
            const V3d q = V3d(p) - V3d(0.1f, 0.2f, 0.3f);
            const V3d beyond(std::abs(q.x) - half.x, std::abs(q.y) - half.y, std::abs(q.z) - half.z);
            const double out = std::max({beyond.x, beyond.y, beyond.z});
            // Near the inset's edges the field may hold the distance to the wrong one of two faces.
            const int near_edge =
                (beyond.x > -2 * region->voxel) + (beyond.y > -2 * region->voxel) + (beyond.z > -2 * region->voxel);
            EXPECT_LT(out, near_edge > 1 ? 0.25 * region->voxel : 1e-3 * depth);
            if (near_edge == 1) {
                EXPECT_GT(out, -1e-3 * depth);
            }
            on_faces += out > -1e-3 * depth;
        }
        // Vertices lie inside only near the edges.
        EXPECT_GT(static_cast<double>(on_faces) / static_cast<double>(region->positions.size()),
                  depth > 0.2 ? 0.6 : 0.9);
        const double volume = signed_volume(to_mesh(*region)), exact = 8 * half.x * half.y * half.z;
        EXPECT_LT(volume, exact * (1 + 1e-5));
        EXPECT_GT(volume, exact - 4 * (half.x + half.y + half.z) * 2 * region->voxel * region->voxel);
        EXPECT_GT(least_distance(*region, box), depth - 0.25 * region->voxel);
    }
}

TEST(InsetOfMesh, MeetsASphere)
{
    const RegionSurface ball = to_surface(icosphere(4));
    const auto region = inset(ball, 0.25);
    ASSERT_TRUE(region);
    EXPECT_TRUE(is_closed_and_oriented(to_mesh(*region)));
    EXPECT_NEAR(signed_volume(to_mesh(*region)), 4 * pi / 3 * 0.75 * 0.75 * 0.75, 0.02);
    EXPECT_GT(least_distance(*region, ball), 0.25 - region->voxel);
}

TEST(InsetOfMesh, IsNothingWhereNothingIsDeepAndTheMeshItselfAtNoDepth)
{
    const RegionSurface box = to_surface(cube());
    EXPECT_FALSE(inset(box, 1));
    EXPECT_FALSE(inset(box, 1.5));
    EXPECT_FALSE(inset(to_surface(icosphere(3)), 0.999));
    EXPECT_TRUE(inset(box, 0.9));
    const auto same = inset(box, 0);
    ASSERT_TRUE(same);
    EXPECT_EQ(same->positions, box.positions);
    EXPECT_EQ(same->triangles, box.triangles);
    EXPECT_FALSE(inset(RegionSurface(), 1));
}

TEST(InsetOfMesh, LeavesCavitiesOut)
{
    // A ball with a cavity that has an island in it.
    const RegionSurface unit = to_surface(icosphere(3));
    const RegionSurface hollow = joined(unit, to_surface(icosphere(3), V3d(0.6)), true);
    const auto shell = inset(hollow, 0.1);
    ASSERT_TRUE(shell);
    EXPECT_TRUE(is_closed_and_oriented(to_mesh(*shell)));
    const auto ball = [](double r) { return 4 * pi / 3 * r * r * r; };
    EXPECT_NEAR(signed_volume(to_mesh(*shell)), ball(0.9) - ball(0.7), 0.08);
    const RegionSurface island = joined(hollow, to_surface(icosphere(3), V3d(0.3)), false);
    const auto both = inset(island, 0.1);
    ASSERT_TRUE(both);
    EXPECT_NEAR(signed_volume(to_mesh(*both)), ball(0.9) - ball(0.7) + ball(0.2), 0.08);
    EXPECT_GT(least_distance(*both, island), 0.1 - both->voxel);
}

TEST(InsetOfMesh, TakesCoarserVoxelsWhereFineOnesWouldBeTooMany)
{
    const RegionSurface box = to_surface(cube());
    const double depth = 1e-3;
    const auto region = inset(box, depth);
    ASSERT_TRUE(region);
    EXPECT_TRUE(region->coarsened);
    EXPECT_GT(region->voxel, depth / 4);
    for (const V3f& p : region->positions)
        EXPECT_LT(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), 1 - depth * (1 - 1e-3));
}

TEST(InsetOfMesh, IsTheSameInAUnitThatIsAPowerOfTwo)
{
    const RegionSurface ball = to_surface(icosphere(3), V3d(1.1, 0.9, 1)),
                        larger = to_surface(icosphere(3), V3d(1.1, 0.9, 1) * 0x1p20);
    const auto a = inset(ball, 0.2), b = inset(larger, 0.2 * 0x1p20);
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->triangles, b->triangles);
    for (size_t i = 0; i < a->positions.size(); ++i) EXPECT_EQ(a->positions[i] * 0x1p20f, b->positions[i]);
}

TEST(InsetOfMesh, RefusesOpenMeshesAndNegativeDepths)
{
    RegionSurface open = to_surface(cube());
    EXPECT_THROW(inset(open, -1), InputError);
    EXPECT_THROW(inset(open, NAN), InputError);
    open.triangles.pop_back();
    EXPECT_THROW(inset(open, 0.1), InputError);
    Progress progress;
    progress.cancel();
    const RegionSurface box = to_surface(cube());
    EXPECT_THROW(inset_of_mesh(box.positions, box.triangles, 0.1, progress), Cancelled);
}

/// A bed of spheres of radius 1: those with centres in -half..half, so its faces are about half + 1 from the middle.
Spheres block_of_bed(double fraction, const V3d& half)
{
    const auto tile = push_apart(300, fraction, 1, 0.01, 5);
    const double edge = packing_edge(tile, fraction);
    const int cells = static_cast<int>(std::ceil(2 * std::max({half.x, half.y, half.z}) / edge)) + 1;
    Spheres spheres;
    for (const PackedSphere& s :
         repeat_packing(tile, edge, cells, tile.size() * static_cast<uint64_t>(cells * cells * cells))) {
        const V3d& p = s.center;
        if (std::abs(p.x) <= half.x && std::abs(p.y) <= half.y && std::abs(p.z) <= half.z)
            spheres.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 1});
    }
    return spheres;
}

/// Mean of |z| where rays along z towards the middle enter the surface, over a grid of points within `reach` of the
/// axis.
double mean_height(const RegionSurface& region, double reach)
{
    double sum = 0;
    int count = 0;
    for (double x = -reach; x <= reach; x += 1.03)
        for (double y = -reach; y <= reach; y += 1.03)
            for (const double side : {-1.0, 1.0}) {
                double highest = -INFINITY;
                for (const auto& t : region.triangles) {
                    const V3d a(region.positions[t[0]]), b(region.positions[t[1]]), c(region.positions[t[2]]);
                    const auto cross = [&](const V3d& p, const V3d& q) {
                        return (p.x - x) * (q.y - y) - (p.y - y) * (q.x - x);
                    };
                    const double u = cross(b, c), v = cross(c, a), w = cross(a, b), all = u + v + w;
                    if (all == 0 || u * all < 0 || v * all < 0 || w * all < 0) continue;
                    highest = std::max(highest, side * (u * a.z + v * b.z + w * c.z) / all);
                }
                sum += highest;
                ++count;
            }
    return sum / count;
}

/// The radius of the largest ball around a point that intersects no sphere; negative inside spheres.
double void_radius(const Spheres& spheres, const V3d& place)
{
    double least = INFINITY;
    for (const auto& s : spheres) least = std::min(least, (V3d(s.x, s.y, s.z) - place).length() - s.r);
    return least;
}

TEST(CoreOfSpheres, LiesBelowTheFacesOfABlock)
{
    const V3d half(14, 14, 10);
    const Spheres spheres = block_of_bed(0.6, half);
    for (const double depth : {1.0, 4.0}) {
        const auto region = core(spheres, depth);
        ASSERT_TRUE(region);
        EXPECT_TRUE(is_balanced(*region));
        EXPECT_FALSE(region->coarsened);
        EXPECT_NEAR(region->voxel, 1, 1e-6);
        // The centres end at the cut: the grains' volume beyond it equals the volume below it of the removed grains.
        EXPECT_NEAR(mean_height(*region, 5), half.z - depth, 0.5) << depth;
        const V3d expected = (half - V3d(depth)) * 2;
        EXPECT_NEAR(std::cbrt(signed_volume(to_mesh(*region))), std::cbrt(expected.x * expected.y * expected.z), 0.5)
            << depth;
    }
}

TEST(CoreOfSpheres, HasNoPointNearTheOutside)
{
    const V3d half(8, 8, 8);
    const Spheres spheres = block_of_bed(0.6, half);
    const HeapOptions options;
    const double depth = 2;
    const auto region = core(spheres, depth, options);
    ASSERT_TRUE(region);
    // Points outside: a ball of the closing radius around such a point intersects no sphere, so the hull is that radius
    // away.
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> uniform(-13, 13);
    double nearest = INFINITY;
    int found = 0;
    for (int i = 0; i < 20000; ++i) {
        const V3d outside(uniform(random), uniform(random), uniform(random));
        if (void_radius(spheres, outside) < options.closing) continue;
        ++found;
        for (const V3f& p : region->positions) nearest = std::min(nearest, (V3d(p) - outside).length());
    }
    ASSERT_GT(found, 1000);
    EXPECT_GT(nearest, options.closing + depth - region->voxel);
    EXPECT_LT(nearest, options.closing + depth + 1.5 * region->voxel);
}

TEST(CoreOfSpheres, KeepsLargeCavitiesAndDropsIsolatedGrains)
{
    const V3d half(14, 14, 14);
    Spheres spheres = block_of_bed(0.6, half), hollow;
    const auto whole = core(spheres, 2);
    for (const auto& s : spheres)
        if (V3d(s.x, s.y, s.z).length() > 6) hollow.push_back(s);
    const auto with_cavity = core(hollow, 2);
    ASSERT_TRUE(whole && with_cavity);
    EXPECT_TRUE(is_balanced(*with_cavity));
    const double cavity = signed_volume(to_mesh(*whole)) - signed_volume(to_mesh(*with_cavity));
    EXPECT_NEAR(std::cbrt(cavity / (4 * pi / 3)), 7, 0.7);

    for (int i = 0; i < 20; ++i) spheres.push_back({30.0f + 10 * static_cast<float>(i), 0, 0, 1});
    spheres.push_back({1e6f, 1e6f, 0, 1});
    const auto same = core(spheres, 2);
    ASSERT_TRUE(same);
    EXPECT_EQ(same->triangles.size(), whole->triangles.size());
}

TEST(CoreOfSpheres, IsNothingForThinLayersAndFewGrains)
{
    EXPECT_FALSE(core({}, 1));
    EXPECT_FALSE(core({{0, 0, 0, 1}}, 1.2));
    EXPECT_FALSE(core({{0, 0, 0, 1}, {0, 0, 0, 1}}, 2));
    EXPECT_FALSE(core({{0, 0, 0, 0}}, 1));
    const Spheres layer = block_of_bed(0.6, V3d(20, 20, 1));
    EXPECT_FALSE(core(layer, 3));
    EXPECT_THROW(core(layer, -1), InputError);
    Progress progress;
    progress.cancel();
    EXPECT_THROW(core_of_spheres(layer, 1, progress), Cancelled);
}

TEST(CoreOfSpheres, IsThatOfTheLargeSphereAmongSmallOnes)
{
    Spheres spheres{{0, 0, 0, 1}};
    std::mt19937_64 random(3);
    std::normal_distribution<float> normal;
    for (int i = 0; i < 1000; ++i) {
        const V3f at = V3f(normal(random), normal(random), normal(random)).normalized() * 1.001f;
        spheres.push_back({at.x, at.y, at.z, 0.001f});
    }
    const auto region = core(spheres, 0.25, {.closing = 0.1, .voxel = 0.05});
    ASSERT_TRUE(region);
    EXPECT_TRUE(is_closed_and_oriented(to_mesh(*region)));
    EXPECT_NEAR(signed_volume(to_mesh(*region)), 4 * pi / 3 * 0.75 * 0.75 * 0.75, 0.03);
}

TEST(CoreOfSpheres, IsTheSameInAUnitThatIsAPowerOfTwoAndOnAnyNumberOfThreads)
{
    const Spheres spheres = block_of_bed(0.55, V3d(8));
    Spheres larger = spheres;
    for (auto& s : larger) s = {s.x * 0x1p20f, s.y * 0x1p20f, s.z * 0x1p20f, s.r * 0x1p20f};
    const auto a = core(spheres, 2), b = core(larger, 2 * 0x1p20);
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->triangles, b->triangles);
    for (size_t i = 0; i < a->positions.size(); ++i) EXPECT_EQ(a->positions[i] * 0x1p20f, b->positions[i]);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto alone = core(spheres, 2);
    ASSERT_TRUE(alone);
    EXPECT_EQ(alone->triangles, a->triangles);
    EXPECT_EQ(alone->positions, a->positions);
}

} // namespace
} // namespace scree
