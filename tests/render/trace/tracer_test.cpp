// The tracer against brute force in double, which tests every sphere and every triangle.
//
// Embree proposes in float, so a ray within rounding of an edge or a silhouette may hit or miss. Brute force recognises
// such rays by a margin; they must be rare. All other rays must agree.

#include "render/embree/triangle.h"
#include "tests/builders/scenes.h"
#include "tests/builders/shapes.h"
#include "tests/render/trace/brute_force.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

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
        const bool same = hit.place.kind == truth.place.kind &&
                          (hit.place.kind == HitKind::none ||
                           (hit.place.index == truth.place.index && hit.place.triangle == truth.place.triangle));
        if (!same) {
            if (++wrong <= 3) {
                ADD_FAILURE() << "from " << o << " along " << d << ": met kind " << int(hit.place.kind) << " index "
                              << hit.place.index << " triangle " << hit.place.triangle << " at " << hit.t
                              << ", brute force kind " << int(truth.place.kind) << " index " << truth.place.index
                              << " triangle " << truth.place.triangle << " at " << truth.t;
            }
            return;
        }
        if (hit.place.kind == HitKind::none) return;
        worst = std::max(worst, std::abs(hit.t - truth.t));
        const double slack =
            tolerance / std::max(1e-4, std::abs(hit.normal.dot(d))); // a hit at grazing angle is less precise
        const bool right = std::abs(hit.t - truth.t) <= slack && (hit.point - (o + truth.t * d)).length() <= slack &&
                           std::abs(hit.normal.length() - 1) < 1e-12;
        V3d normal = hit.normal;
        if (hit.place.kind == HitKind::grain) {
            normal =
                hit.place.triangle == no_triangle
                    ? (hit.point - world.grains.centre(hit.place.index)).normalized()
                    : unit_normal(grain_triangle(world, static_cast<uint32_t>(hit.place.index), hit.place.triangle));
        }
        EXPECT_LT((hit.normal - normal).length(), 1e-9);
        if (!right && ++wrong <= 3) {
            ADD_FAILURE() << "from " << o << " along " << d << ": t " << hit.t << " and " << truth.t << ", point "
                          << hit.point << ", normal " << hit.normal;
        }
    }
    void expect_good(const std::string& name, double close_fraction, double hit_fraction) const
    {
        EXPECT_EQ(wrong, 0) << name;
        EXPECT_LT(close, close_fraction * rays) << name;
        EXPECT_GT(hits, hit_fraction * rays) << name;
        std::printf("%-40s %6d rays, %6d hits, %3d too close to call, t within %.1e\n", name.c_str(), rays, hits, close,
                    worst);
    }
};

/// 300 overlapping spheres with radii from 0.002 to 0.5, uniform in the logarithm.
void add_spheres(TestScene& scene, uint32_t type, int count = 300)
{
    Sampler sampler(77, 0, 0, 0);
    for (int i = 0; i < count; ++i) {
        const V3d c = random_point(sampler, 0.95);
        scene.add_grain(c, 0.5 * std::pow(1 / 256.0, sampler.next()), type);
    }
}

/// 120 icosahedra, cubes and bent plates (not convex), which overlap strongly.
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
    const uint32_t types[] = {scene.add_type(material, icosphere(1)), scene.add_type(material, cube()),
                              scene.add_type(material, bracket)};
    Sampler sampler(78, 0, 0, 0);
    for (int i = 0; i < 120; ++i)
        scene.add_grain(random_point(sampler, 0.9), 0.05 + 0.35 * sampler.next() * sampler.next(), types[i % 3]);
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
void PrintTo(Kind kind, std::ostream* out)
{
    *out << std::array{"spheres", "meshes", "surfaces", "all"}[static_cast<size_t>(kind)];
}

class TracerAgainstBruteForce : public testing::TestWithParam<Kind> {
protected:
    TracerAgainstBruteForce()
    {
        const Kind kind = GetParam();
        if (kind == Kind::spheres || kind == Kind::all)
            add_spheres(scene_, scene_.add_type(dielectric(1.5)), kind == Kind::all ? 100 : 300);
        if (kind == Kind::meshes || kind == Kind::all) add_meshes(scene_, dielectric(1.4));
        if (kind == Kind::surfaces || kind == Kind::all) {
            scene_.add_surface(triangle_soup(5, 60), lambert(0.5f));
            scene_.add_surface(triangle_soup(6, 40), dielectric(1.3));
        }
        scene_.build();
        truth_ = std::make_unique<BruteForce>(scene_.world());
    }
    /// A point among the objects, or some distance outside; and a direction, often towards a grain.
    void random_ray(Sampler& sampler, V3d& o, V3d& d) const
    {
        o = random_point(sampler, sampler.next() < 0.7 ? 0.5 : 1.5);
        d = random_direction(sampler);
        if (world().grains.size() == 0 || sampler.next() < 0.2) return;
        const auto grain = static_cast<uint32_t>(sampler.next() * world().grains.size());
        d = (world().grains.centre(grain) +
             world().grains.radius(grain) * std::cbrt(sampler.next()) * random_direction(sampler) - o)
                .normalized();
    }
    const BruteForce& truth() const { return *truth_; }
    const World& world() const { return scene_.world(); }
    const Tracer& tracer() const { return scene_.tracer(); }
    /// Spheres are decided in double; hits of meshes have Embree's float precision.
    double tolerance() const { return GetParam() == Kind::spheres ? 1e-9 : 4 * float_margin; }
    int rays() const { return GetParam() == Kind::spheres ? 40000 : 6000; }

    TestScene scene_;
    std::unique_ptr<BruteForce> truth_;
};
INSTANTIATE_TEST_SUITE_P(Scenes, TracerAgainstBruteForce,
                         testing::Values(Kind::spheres, Kind::meshes, Kind::surfaces, Kind::all),
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
            // The expected hit is computed from a nearby point, reached in double.
            const double skip = distance - 5;
            Truth expected = truth().outside(o + skip * exact, exact, {});
            expected.t += skip;
            comparison.check(world(), tracer().intersect(o, exact, {}), expected, o, exact,
                             tolerance() + 0x1p-50 * distance);
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
        // A face turned towards the ray: its outward normal is against d. Grazing directions too.
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
        const auto grain = static_cast<uint32_t>(hit.place.index);
        Hit way_out = tracer().intersect_inside(hit.place, hit.point, in, hit.place);
        const Truth expected = truth().inside(grain, hit.point, in, hit.place);
        lost += way_out.place.kind == HitKind::none && !expected.close;
        comparison.check(world(), way_out, expected, hit.point, in, tolerance());
        // The ray goes on from there, still inside, as after total reflection.
        if (way_out.place.kind != HitKind::grain) continue;
        V3d back = random_direction(sampler);
        if (back.dot(way_out.normal) > 0) back = -back;
        comparison.check(world(), tracer().intersect_inside(way_out.place, way_out.point, back, way_out.place),
                         truth().inside(grain, way_out.point, back, way_out.place), way_out.point, back, tolerance());
    }
    EXPECT_EQ(lost, 0);
    // a quarter of the rays is grazing, and many of those are near a boundary
    comparison.expect_good("inside", 0.25, 0.5);
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
        const double tmax = i % 3 == 0   ? infinity
                            : i % 3 == 1 ? 3 * sampler.next()
                                         : expected.t * (sampler.next() < 0.5 ? 0.999 : 1.001);
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
            ADD_FAILURE() << "from " << o << " along " << d << " up to " << tmax << ": occluded " << found
                          << ", intersect " << met << " at " << hit.t << ", brute force " << expected.t;
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(blocked, rays() / 10);
    EXPECT_LT(too_close, rays() / 30);
}

} // namespace
} // namespace scree
