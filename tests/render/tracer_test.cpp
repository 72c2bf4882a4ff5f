// The tracer against brute force in double: every sphere and every triangle tried, one by one.
//
// Embree proposes in float, so what passes an edge or a silhouette within its rounding may go either way; such rays are
// told by the margin that brute force keeps, and must be rare. Everything else must agree.

#include "render/grains/triangle.h"
#include "render/sampler.h"
#include "render/warp.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace scree {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double float_margin = 0x1p-20; ///< of rays through render coordinates of size 1: a few roundings of 2^-24

V3d random_direction(Sampler& sampler)
{
    const double z = 2 * sampler.next() - 1, phi = 2 * pi * sampler.next(), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

V3d random_point(Sampler& sampler, double half)
{
    return half * V3d(2 * sampler.next() - 1, 2 * sampler.next() - 1, 2 * sampler.next() - 1);
}

/// What brute force knows of one ray: the nearest hit, and whether anything came so close to being another answer that
/// rounding to float may decide.
struct Truth {
    Place place;
    double t = infinity, second = infinity;
    bool close = false;
    double doubtful = infinity; ///< distance of the nearest thing grazed

    void offer(const Place& candidate, double at)
    {
        if (at >= t) {
            second = std::min(second, at);
            return;
        }
        second = t;
        t = at;
        place = candidate;
    }
    void doubt(double at) { doubtful = std::min(doubtful, at); }
    /// Call when all are offered.
    void judge() { close = std::min(doubtful, second) < t + float_margin; }
};

std::array<V3d, 3> grain_triangle(const World& world, uint32_t grain, uint32_t triangle)
{
    const Imath::M33d rotation = world.grains.rotation(grain);
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

class BruteForce {
public:
    explicit BruteForce(const World& world) : world_(world)
    {
        for (uint32_t i = world.grains.analytic_count; i < world.grains.size(); ++i) {
            first_of_grain_.push_back(triangles_.size());
            const uint64_t count = world.types[world.grains.type_codes[i]].exemplar->triangle_count();
            for (uint32_t k = 0; k < count; ++k) add({HitKind::grain, i, k}, grain_triangle(world, i, k));
        }
        first_of_grain_.push_back(triangles_.size());
        for (uint32_t i = 0; i < world.surfaces.size(); ++i) {
            for (uint32_t k = 0; k < world.surfaces[i].triangles.size(); ++k) add({HitKind::surface, i, k}, surface_triangle(world, i, k));
        }
    }

    /// From outside all grains.
    Truth outside(const V3d& o, const V3d& d, const Place& from) const
    {
        Truth truth;
        for (uint32_t i = 0; i < world_.grains.analytic_count; ++i) try_sphere(i, o, d, from, truth);
        for (const Triangle& triangle : triangles_) try_triangle(triangle, true, o, d, from, truth);
        truth.judge();
        return truth;
    }
    /// From inside one grain, on its way out or to a surface.
    Truth inside(uint32_t grain, const V3d& o, const V3d& d, const Place& from) const
    {
        Truth truth;
        size_t k = first_of_grain_.back();
        if (grain < world_.grains.analytic_count) {
            const V3d to = world_.grains.centre(grain) - o;
            const double along = to.dot(d), r = world_.grains.radius(grain);
            truth.offer({HitKind::grain, grain, no_triangle}, along + safe_sqrt(r * r - (to - along * d).length2()));
        } else {
            const size_t mesh = grain - world_.grains.analytic_count;
            for (size_t j = first_of_grain_[mesh]; j < first_of_grain_[mesh + 1]; ++j) try_triangle(triangles_[j], false, o, d, from, truth);
        }
        for (; k < triangles_.size(); ++k) try_triangle(triangles_[k], false, o, d, from, truth);
        truth.judge();
        return truth;
    }

private:
    struct Triangle {
        Place place;
        std::array<V3d, 3> c;
        V3d normal;
        double height; ///< the smallest: what one barycentric unit is at least
    };
    void add(const Place& place, const std::array<V3d, 3>& c)
    {
        const double longest = std::max({(c[1] - c[0]).length(), (c[2] - c[0]).length(), (c[2] - c[1]).length()});
        triangles_.push_back({place, c, unit_normal(c), (c[1] - c[0]).cross(c[2] - c[0]).length() / longest});
    }

    /// A sphere is met where the ray enters it; one that holds the start is not.
    void try_sphere(uint32_t i, const V3d& o, const V3d& d, const Place& from, Truth& truth) const
    {
        if (from.kind == HitKind::grain && from.index == i) return;
        const V3d to = world_.grains.centre(i) - o;
        const double r = world_.grains.radius(i), along = to.dot(d), nearest = (to - along * d).length();
        if (to.length() < r || along <= 0) return;
        if (std::abs(nearest - r) < float_margin * (1 + along)) truth.doubt(along - r);
        if (nearest < r) truth.offer({HitKind::grain, i, no_triangle}, along - std::sqrt(r * r - nearest * nearest));
    }

    /// Of a grain's triangles only those that the ray enters (or leaves) through; of surfaces all.
    static void try_triangle(const Triangle& triangle, bool entering, const V3d& o, const V3d& d, const Place& from, Truth& truth)
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

    const World& world_;
    std::vector<Triangle> triangles_; // of grains, then of surfaces
    std::vector<size_t> first_of_grain_;
};

/// Counts agreement of many rays; `check` compares one.
struct Comparison {
    int rays = 0, hits = 0, close = 0, wrong = 0;
    double worst = 0; ///< difference of distances

    void check(const World& world, const Hit& hit, const Truth& truth, const V3d& o, const V3d& d, double tolerance)
    {
        ++rays;
        if (truth.close) {
            ++close;
            return;
        }
        hits += truth.place.kind != HitKind::none;
        const bool same = hit.place.kind == truth.place.kind && (hit.place.kind == HitKind::none || (hit.place.index == truth.place.index && hit.place.triangle == truth.place.triangle));
        if (!same) {
            if (++wrong <= 3) {
                ADD_FAILURE() << "from " << o << " along " << d << ": met kind " << int(hit.place.kind) << " index " << hit.place.index << " triangle "
                              << hit.place.triangle << " at " << hit.t << ", brute force kind " << int(truth.place.kind) << " index " << truth.place.index
                              << " triangle " << truth.place.triangle << " at " << truth.t;
            }
            return;
        }
        if (hit.place.kind == HitKind::none) return;
        worst = std::max(worst, std::abs(hit.t - truth.t));
        const double slack = tolerance / std::max(1e-4, std::abs(hit.normal.dot(d))); // a grazed plane is met less precisely
        const bool right = std::abs(hit.t - truth.t) <= slack && (hit.point - (o + truth.t * d)).length() <= slack &&
                           std::abs(hit.normal.length() - 1) < 1e-12;
        V3d normal = hit.normal;
        if (hit.place.kind == HitKind::grain) {
            normal = hit.place.triangle == no_triangle ? (hit.point - world.grains.centre(hit.place.index)).normalized()
                                                       : unit_normal(grain_triangle(world, hit.place.index, hit.place.triangle));
        }
        EXPECT_LT((hit.normal - normal).length(), 1e-9);
        if (!right && ++wrong <= 3) {
            ADD_FAILURE() << "from " << o << " along " << d << ": t " << hit.t << " and " << truth.t << ", point " << hit.point << ", normal " << hit.normal;
        }
    }
    void expect_good(const std::string& name, double close_fraction, double hit_fraction) const
    {
        EXPECT_EQ(wrong, 0) << name;
        EXPECT_LT(close, close_fraction * rays) << name;
        EXPECT_GT(hits, hit_fraction * rays) << name;
        std::printf("%-40s %6d rays, %6d hits, %3d too close to call, t within %.1e\n", name.c_str(), rays, hits, close, worst);
    }
};

/// 300 overlapping spheres, radii 0.002 to 0.5 evenly in their logarithm.
void add_spheres(TestScene& scene, uint32_t type, int count = 300)
{
    Sampler sampler(77, 0, 0, 0);
    for (int i = 0; i < count; ++i) {
        const V3d c = random_point(sampler, 0.95);
        scene.add_grain(c, 0.5 * std::pow(1 / 256.0, sampler.next()), type);
    }
}

/// 120 icosahedra, cubes and bent plates (not convex), overlapping far.
void add_meshes(TestScene& scene, const Material& material)
{
    // An L: a cube with a corner cut out, as a prism.
    TriangleMesh bracket;
    const double xy[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (const double z : {0.0, 0.7}) {
        for (const auto& p : xy) bracket.positions.emplace_back(p[0], p[1], z);
    }
    const std::array<uint32_t, 3> cap[4] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    for (const auto& t : cap) {
        bracket.triangles.push_back({t[0], t[2], t[1]});
        bracket.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
    }
    for (uint32_t i = 0; i < 6; ++i) {
        const uint32_t j = (i + 1) % 6;
        bracket.triangles.push_back({i, j, j + 6});
        bracket.triangles.push_back({i, j + 6, i + 6});
    }
    const uint32_t types[] = {scene.add_type(material, icosphere(1)), scene.add_type(material, cube()), scene.add_type(material, bracket)};
    Sampler sampler(78, 0, 0, 0);
    for (int i = 0; i < 120; ++i) scene.add_grain(random_point(sampler, 0.9), 0.05 + 0.35 * sampler.next() * sampler.next(), types[i % 3]);
}

TriangleMesh triangle_soup(uint64_t seed, int count)
{
    TriangleMesh mesh;
    Sampler sampler(seed, 0, 0, 0);
    for (uint32_t i = 0; i < static_cast<uint32_t>(count); ++i) {
        const V3d middle = random_point(sampler, 0.9);
        for (int k = 0; k < 3; ++k) mesh.positions.push_back(middle + random_point(sampler, 0.4));
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

/// The four kinds of scenes that are traced.
enum class Kind { spheres, meshes, surfaces, all };
void PrintTo(Kind kind, std::ostream* out) { *out << std::array{"spheres", "meshes", "surfaces", "all"}[static_cast<size_t>(kind)]; }

class TracerAgainstBruteForce : public testing::TestWithParam<Kind> {
protected:
    TracerAgainstBruteForce()
    {
        const Kind kind = GetParam();
        if (kind == Kind::spheres || kind == Kind::all) add_spheres(scene_, scene_.add_type(dielectric(1.5)), kind == Kind::all ? 100 : 300);
        if (kind == Kind::meshes || kind == Kind::all) add_meshes(scene_, dielectric(1.4));
        if (kind == Kind::surfaces || kind == Kind::all) {
            scene_.add_surface(triangle_soup(5, 60), lambert(0.5f));
            scene_.add_surface(triangle_soup(6, 40), dielectric(1.3));
        }
        scene_.build();
        truth_ = std::make_unique<BruteForce>(scene_.world());
    }
    /// A point among the things, or some way outside; and a direction, often towards a grain.
    void random_ray(Sampler& sampler, V3d& o, V3d& d) const
    {
        o = random_point(sampler, sampler.next() < 0.7 ? 0.5 : 1.5);
        d = random_direction(sampler);
        if (world().grains.size() == 0 || sampler.next() < 0.2) return;
        const auto grain = static_cast<uint32_t>(sampler.next() * world().grains.size());
        d = (world().grains.centre(grain) + world().grains.radius(grain) * std::cbrt(sampler.next()) * random_direction(sampler) - o).normalized();
    }
    const BruteForce& truth() const { return *truth_; }
    const World& world() const { return scene_.world(); }
    const Tracer& tracer() const { return scene_.tracer(); }
    /// Spheres are decided in double; of a mesh's hit Embree's float remains.
    double tolerance() const { return GetParam() == Kind::spheres ? 1e-9 : 4 * float_margin; }
    int rays() const { return GetParam() == Kind::spheres ? 40000 : 6000; }

    TestScene scene_;
    std::unique_ptr<BruteForce> truth_;
};
INSTANTIATE_TEST_SUITE_P(Scenes, TracerAgainstBruteForce, testing::Values(Kind::spheres, Kind::meshes, Kind::surfaces, Kind::all),
                         [](const auto& test) { return testing::PrintToString(test.param); });

TEST_P(TracerAgainstBruteForce, RaysFromAnywhere)
{
    Comparison comparison;
    Sampler sampler(1, 0, 0, 0);
    for (int i = 0; i < rays(); ++i) {
        V3d o, d;
        random_ray(sampler, o, d);
        comparison.check(world(), tracer().intersect(o, d, {}), truth().outside(o, d, {}), o, d, tolerance());
    }
    comparison.expect_good("anywhere", 0.01, 0.3);
}

TEST_P(TracerAgainstBruteForce, RaysFromFarAway)
{
    for (const double distance : {10.0, 1e3, 1e6, 1e9}) {
        Comparison comparison;
        Sampler sampler(2, 0, 0, 0);
        for (int i = 0; i < rays() / 2; ++i) {
            V3d target, d;
            random_ray(sampler, target, d);
            target *= 0.5;
            const V3d o = target - distance * d;
            const V3d exact = (target - o).normalized();
            // The truth is told from a point near by, reached in double.
            const double skip = distance - 5;
            Truth expected = truth().outside(o + skip * exact, exact, {});
            expected.t += skip;
            comparison.check(world(), tracer().intersect(o, exact, {}), expected, o, exact, tolerance() + 0x1p-50 * distance);
        }
        comparison.expect_good("from " + std::to_string(distance), 0.02, 0.3);
    }
}

TEST_P(TracerAgainstBruteForce, RaysThatLeaveWhatTheyMet)
{
    Comparison comparison;
    Sampler sampler(3, 0, 0, 0);
    for (int i = 0; i < rays(); ++i) {
        V3d o, d;
        random_ray(sampler, o, d);
        const Hit hit = tracer().intersect(o, d, {});
        if (hit.place.kind == HitKind::none) continue;
        V3d out = random_direction(sampler);
        // A face turned towards the ray: outwards is against d. Grazing directions too.
        const V3d facing = hit.normal * (hit.normal.dot(d) < 0 ? 1 : -1);
        if (i % 4 == 0) out = (out - out.dot(facing) * facing + 1e-4 * sampler.next() * facing).normalized();
        if (out.dot(facing) < 0) out = -out;
        const Truth expected = truth().outside(hit.point, out, hit.place);
        comparison.check(world(), tracer().intersect(hit.point, out, hit.place), expected, hit.point, out, tolerance());
    }
    comparison.expect_good("leaving", 0.02, 0.1);
}

TEST_P(TracerAgainstBruteForce, RaysInsideGrains)
{
    if (world().grains.size() == 0) return;
    Comparison comparison;
    int lost = 0;
    Sampler sampler(4, 0, 0, 0);
    for (int i = 0; i < rays(); ++i) {
        V3d o, d;
        random_ray(sampler, o, d);
        const Hit hit = tracer().intersect(o, d, {});
        if (hit.place.kind != HitKind::grain) continue;
        V3d in = random_direction(sampler);
        if (i % 4 == 0) in = (in - in.dot(hit.normal) * hit.normal - 1e-4 * sampler.next() * hit.normal).normalized();
        if (in.dot(hit.normal) > 0) in = -in;
        const uint32_t grain = hit.place.index;
        Hit way_out = tracer().intersect_inside(grain, hit.point, in, hit.place);
        const Truth expected = truth().inside(grain, hit.point, in, hit.place);
        lost += way_out.place.kind == HitKind::none && !expected.close;
        comparison.check(world(), way_out, expected, hit.point, in, tolerance());
        // And on from there, still inside, as after total reflection.
        if (way_out.place.kind != HitKind::grain) continue;
        V3d back = random_direction(sampler);
        if (back.dot(way_out.normal) > 0) back = -back;
        comparison.check(world(), tracer().intersect_inside(grain, way_out.point, back, way_out.place),
                         truth().inside(grain, way_out.point, back, way_out.place), way_out.point, back, tolerance());
    }
    EXPECT_EQ(lost, 0);
    comparison.expect_good("inside", 0.25, 0.5); // a quarter of the rays grazes: many of those are close
}

TEST_P(TracerAgainstBruteForce, OcclusionIsConsistentWithIntersection)
{
    Sampler sampler(5, 0, 0, 0);
    int blocked = 0, wrong = 0, too_close = 0;
    for (int i = 0; i < rays(); ++i) {
        V3d o, d;
        random_ray(sampler, o, d);
        Place from;
        if (i % 2 == 0) { // half of them start on something, as shadow rays do
            const Hit hit = tracer().intersect(o, d, {});
            if (hit.place.kind == HitKind::none) continue;
            from = hit.place;
            o = hit.point;
            const double side = hit.normal.dot(d);
            d = random_direction(sampler);
            if (d.dot(hit.normal) * side > 0) d = -d;
        }
        const Truth expected = truth().outside(o, d, from);
        const double tmax = i % 3 == 0 ? infinity : i % 3 == 1 ? 3 * sampler.next() : expected.t * (sampler.next() < 0.5 ? 0.999 : 1.001);
        if (expected.close || std::abs(expected.t - tmax) < 4 * float_margin) {
            ++too_close;
            continue;
        }
        const bool blocks = expected.t < tmax;
        blocked += blocks;
        const bool found = tracer().occluded(o, d, tmax, from, 0);
        const Hit hit = tracer().intersect(o, d, from);
        const bool met = hit.place.kind != HitKind::none && hit.t < tmax;
        if ((found != blocks || met != blocks) && ++wrong < 4) {
            ADD_FAILURE() << "from " << o << " along " << d << " up to " << tmax << ": occluded " << found << ", intersect " << met << " at " << hit.t
                          << ", brute force " << expected.t;
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(blocked, rays() / 10);
    EXPECT_LT(too_close, rays() / 30);
}

// --- what a ray starts on ---

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
        ASSERT_FALSE(hit.place.kind == HitKind::grain && hit.place.index == grain) << grain << " from " << o << " along " << d;
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

// From a face of a convex solid outwards there is nothing of the solid, also from its edges and corners; far from the
// origin, where a float is coarse, and for tiny ones.
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
            ADD_FAILURE() << "grain " << grain << " triangle " << triangle << " from " << o << " (case " << i % 6 << ") along " << d << ", cosine "
                          << d.dot(unit_normal(corners)) << ", met triangle " << hit.place.triangle << " at " << hit.t;
        }
    }
    EXPECT_EQ(wrong, 0);
}

// Inwards from a face, an edge or a corner: the ray goes on inside, never through the face it starts on, never farther
// than the solid is wide, and is hardly ever lost.
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
        const Hit hit = scene.tracer().intersect_inside(grain, o, d, {HitKind::grain, grain, triangle});
        const double r = world.grains.radius(grain);
        if (hit.place.kind == HitKind::none) {
            (i % 6 == 5 ? lost_within : lost_at_edges) += 1;
            continue;
        }
        const bool right = hit.place.index == grain && hit.place.triangle != triangle && hit.t >= 0 && hit.t <= 2.001 * r &&
                           hit.normal.dot(d) > 0 && (hit.point - (o + hit.t * d)).length() < 2 * float_margin * r / std::max(1e-4, hit.normal.dot(d));
        if (!right && ++wrong < 4) {
            ADD_FAILURE() << "grain " << grain << " triangle " << triangle << " from " << o << " along " << d << ": triangle " << hit.place.triangle << " at "
                          << hit.t / r << " radii, " << (hit.point - (o + hit.t * d)).length() / r << " off the ray";
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
        for (int i = 0; i <= 8; ++i) plane.positions.push_back(V3d(-3, 0.1, 0) + 0.123 * i * V3d(1, 0.2, 0.1) + 0.177 * j * V3d(-0.1, 1, 0.3));
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
        const std::array<V3d, 3> corners{V3d(surface.positions[t[0]]), V3d(surface.positions[t[1]]), V3d(surface.positions[t[2]])};
        const V3d n = unit_normal(corners) * (index == 2 && i % 2 ? -1 : 1); // the plane from both sides
        const V3d o = point_of(corners, sampler, i), d = leaving_direction(sampler, n, i);
        const Place from{HitKind::surface, index, triangle};
        const Hit hit = scene.tracer().intersect(o, d, from);
        const bool again = hit.place.kind == HitKind::surface && hit.place.index == index;
        const bool shadowed = hit.place.kind == HitKind::none && scene.tracer().occluded(o, d, infinity, from, 0);
        if ((again || shadowed) && ++wrong < 4) {
            ADD_FAILURE() << "surface " << index << " triangle " << triangle << " from " << o << " (case " << i % 6 << ") along " << d << ", cosine " << d.dot(n)
                          << ", met triangle " << hit.place.triangle << " at " << hit.t;
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
    for (const V3f& p : world.surfaces[0].positions) ball_middle += V3d(p) / static_cast<double>(world.surfaces[0].positions.size());
    for (int i = 0; i < 60000; ++i) {
        const auto triangle = static_cast<uint32_t>(sampler.next() * 320);
        const V3d on_grain = point_of(grain_triangle(world, 0, triangle), sampler, i % 4);
        const V3d away = (on_grain - middle).normalized();
        V3d side = random_direction(sampler);
        const V3d o = on_grain + 0.2 * away + 0.15 * side, d = (on_grain - o).normalized();
        const Hit hit = scene.tracer().intersect(o, d, {});
        through_grain += hit.place.kind != HitKind::grain || hit.t > (on_grain - o).length() + 1e-5;
        const auto& t = world.surfaces[0].triangles[triangle];
        const std::array<V3d, 3> corners{V3d(world.surfaces[0].positions[t[0]]), V3d(world.surfaces[0].positions[t[1]]), V3d(world.surfaces[0].positions[t[2]])};
        const V3d target = point_of(corners, sampler, i % 4), inside = ball_middle + 0.1 * random_direction(sampler);
        const Hit wall = scene.tracer().intersect(inside, (target - inside).normalized(), {});
        through_surface += wall.place.kind != HitKind::surface;
    }
    EXPECT_EQ(through_grain, 0);
    EXPECT_EQ(through_surface, 0);
}

// A chain of refractions and reflections through one grain: a leak would show as a ray that is lost inside.
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
            const Hit hit = scene.tracer().intersect_inside(grain, o, d, from);
            ++steps;
            if (hit.place.kind == HitKind::none) {
                ++lost;
                break;
            }
            ASSERT_EQ(hit.place.index, grain);
            ASSERT_LE((hit.point - scene.world().grains.centre(grain)).length(), scene.world().grains.radius(grain) * (1 + 1e-6));
            o = hit.point;
            from = hit.place;
            // A mirror on even steps, any direction inwards on odd ones.
            if (step % 2 == 0) d = (d - 2 * d.dot(hit.normal) * hit.normal).normalized();
            else d = leaving_direction(sampler, -hit.normal, 0);
        }
    }
    std::printf("%llu of %llu segments inside were lost\n", static_cast<unsigned long long>(lost), static_cast<unsigned long long>(steps));
    EXPECT_LE(lost, steps / 100000);
}

// --- lights ---

TEST(TracerLights, AreMetWhereTheyAreAndTheTargetDoesNotOcclude)
{
    TestScene scene;
    const uint32_t clay = scene.add_type(lambert(1));
    scene.add_grain(V3d(0), 0.5, clay);
    Light rectangle;
    rectangle.kind = LightKind::rectangle;
    rectangle.corner = V3d(-0.2, -0.2, 0.9);
    rectangle.edge1 = V3d(0.4, 0, 0);
    rectangle.edge2 = V3d(0, 0.4, 0);
    scene.add_light(rectangle);
    Light sphere;
    sphere.kind = LightKind::sphere;
    sphere.center = V3d(0, 0, 2);
    sphere.radius = 0.3;
    scene.add_constant_light(1);
    scene.add_light(sphere);
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
