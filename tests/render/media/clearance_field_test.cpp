#include "render/media/clearance_field.h"

#include "base/error.h"
#include "tests/builders/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <thread>

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

using Wide = Imath::Vec3<long double>;

long double distance_to_segment(const Wide& p, const Wide& a, const Wide& b)
{
    const Wide d = b - a;
    const long double t = d.dot(d) > 0 ? std::clamp((p - a).dot(d) / d.dot(d), 0.0L, 1.0L) : 0;
    const Wide q = p - a - d * t;
    return std::sqrt(q.dot(q));
}

/// In long double, so that its error is far below the accuracy required of the field.
double distance(const Mesh& mesh, const V3d& place)
{
    const Wide p(place);
    long double least = INFINITY;
    for (const auto& t : mesh.triangles) {
        const Wide a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]), n = (b - a).cross(c - a);
        const long double nn = n.dot(n), v = (p - a).cross(c - a).dot(n), w = (b - a).cross(p - a).dot(n);
        if (nn > 0 && v >= 0 && w >= 0 && v + w <= nn)
            least = std::min(least, std::abs((p - a).dot(n)) / std::sqrt(nn));
        else
            least = std::min(
                {least, distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
    }
    return static_cast<double>(least);
}

V3d random_direction(std::mt19937_64& random)
{
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return V3d(x, y, z).normalized();
}

/// Compares with true distances at points in a box, most of them 1e-6 to 0.3 of the box away from points on triangles,
/// edges and corners. typical: the least part of the distance that 9 of 10 bounds must reach. from: distance, as a part
/// of the box, from which on no bound may lose much.
void check(const std::vector<Mesh>& meshes, const Imath::Box3d& box, int places, int voxels = 64,
           double typical = 0.995, double from = 1e-6)
{
    std::vector<TriangleView> views;
    for (const Mesh& m : meshes) views.push_back(m.view());
    const ClearanceField field(views, box, Progress(), voxels);
    const double longest = std::max({box.size().x, box.size().y, box.size().z});
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform;
    std::vector<double> shares, near;
    while (static_cast<int>(shares.size()) < places) {
        V3d p = box.min + box.size() * V3d(uniform(random), uniform(random), uniform(random));
        if (random() % 4 != 0) {
            const Mesh& mesh = meshes[random() % meshes.size()];
            const auto& t = mesh.triangles[random() % mesh.triangles.size()];
            const double u = std::min(1.0, 1.3 * std::sqrt(uniform(random))),
                         v = std::clamp(1.6 * uniform(random) - 0.3, 0.0, 1.0) * u;
            p = V3d(mesh.positions[t[0]]) * (1 - u) + V3d(mesh.positions[t[1]]) * (u - v) +
                V3d(mesh.positions[t[2]]) * v +
                random_direction(random) * (longest * std::pow(10, -6 + 5.5 * uniform(random)));
        }
        if (!box.intersects(p) || p.x == box.max.x || p.y == box.max.y || p.z == box.max.z) continue;
        double truth = INFINITY;
        for (const Mesh& m : meshes) truth = std::min(truth, distance(m, p));
        const double bound = field.clearance(p);
        ASSERT_LE(bound, truth) << p;
        if (truth > from * longest) {
            ASSERT_GE(bound, 0.97 * truth) << p << ' ' << truth / longest;
        }
        shares.push_back(truth > 0 ? bound / truth : 1);
        if (truth < 1e-2 * longest) near.push_back(shares.back());
    }
    std::ranges::sort(shares);
    std::ranges::sort(near);
    EXPECT_GT(shares[shares.size() / 10], typical);
    if (near.size() > 100) {
        EXPECT_GT(near[near.size() / 20], 0.999);
    }
}

Mesh random_triangles(int count, double spread, double size, uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const V3d at = V3d(normal(random), normal(random), normal(random)) * spread;
        for (int k = 0; k < 3; ++k)
            mesh.positions.emplace_back(V3f(at + V3d(normal(random), normal(random), normal(random)) * size));
        const auto first = static_cast<uint32_t>(3 * i);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

Mesh join(Mesh a, const Mesh& b)
{
    const auto first = static_cast<uint32_t>(a.positions.size());
    a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
    for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    return a;
}

/// Slivers of all widths, some without area: a corner twice, three times, or on the opposite edge.
Mesh needles(int count)
{
    Mesh mesh = random_triangles(count, 0.5, 0.3, 11);
    std::mt19937_64 random(12);
    std::uniform_real_distribution<double> uniform;
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        V3f* p = &mesh.positions[3 * t];
        const double width = std::pow(10, -9 * uniform(random)), at = uniform(random);
        if (t % 8 == 0)
            p[2] = p[t % 16 == 0];
        else if (t % 8 == 1)
            p[1] = p[2] = p[0];
        else if (t % 8 == 2)
            p[2] = p[0] * 0.5f + p[1] * 0.5f;
        else
            p[2] = V3f(V3d(p[0]) * at + V3d(p[1]) * (1 - at) + V3d(p[2]) * width);
    }
    return mesh;
}

TEST(ClearanceField, IsNeverAboveTheDistanceAndHardlyBelow)
{
    const Imath::Box3d box(V3d(-1.1, -1.2, -1.3), V3d(1.1, 1.2, 1.3));
    check({make(icosphere(5))}, box, 800);
    check({make(cube())}, box, 15000);
    check({make(icosphere(2))}, box, 3000, 7);
    check({make(icosphere(2))}, box, 3000, 100);
    const Imath::Box3d large(V3d(-4), V3d(4, 4.1, 4.2));
    check({random_triangles(30, 0.6, 0.3, 2)}, large, 10000);
    check({random_triangles(30, 0.6, 0.01, 3)}, large, 10000);
    check({random_triangles(1000, 0.6, 0.1, 5)}, box, 2000);
}

TEST(ClearanceField, HoldsForNeedlesAndTrianglesWithoutArea)
{
    const Imath::Box3d box(V3d(-1.5), V3d(1.5));
    // Where a normal is inaccurate, 2^-24 of the farthest corner's distance is lost.
    check({needles(40)}, box, 20000, 64, 0.995, 1e-5);
    check({needles(600)}, box, 2000, 64, 0.995, 1e-5);
}

TEST(ClearanceField, HoldsForMeshesThatTouchAndTrianglesOfAllSizes)
{
    const Imath::Box3d box(V3d(-1.1, -1.2, -1.3), V3d(1.1, 1.2, 1.3));
    check({make(cube(), V3d(0.7, 0.2, 0.1)), make(icosphere(2), V3d(0.1), V3d(0.5))}, box, 5000);
    check({make(cube(), V3d(0.5), V3d(-0.5, 0, 0)), make(cube(), V3d(0.5), V3d(0.5, 0.25, 0))}, box, 10000);
    check({make(ground(1, 0)), make(icosphere(3), V3d(1e-5), V3d(0.1, 0.2, 1e-5)),
           make(icosphere(3), V3d(1e-3), V3d(-0.3, 0.2, 0))},
          box, 2000);
    check({join(make(ground(1, 0)), random_triangles(300, 1e-4, 1e-5, 8))}, box, 4000);
}

TEST(ClearanceField, CountsTrianglesBeyondTheBox)
{
    const Imath::Box3d box(V3d(-0.5), V3d(0.5, 0.4, 0.3));
    const Imath::Box3d inner(V3d(-0.4, -0.5, -0.3), V3d(0.5, 0.3, 0.4));
    check({random_triangles(40, 0.6, 0.3, 4)}, inner, 20000);
    check({make(icosphere(3), V3d(1e6), V3d(1e6, 0, 0))}, inner, 2000);
    const Mesh plane = make(ground(1000, -0.6));
    const std::vector<TriangleView> view{plane.view()};
    const ClearanceField field(view, box, Progress());
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(-0.5, 0.5);
    for (int i = 0; i < 2000; ++i) {
        const V3d p(uniform(random), 0.8 * uniform(random), 0.6 * uniform(random));
        EXPECT_LE(field.clearance(p), p.z + 0.6);
        EXPECT_GE(field.clearance(p), 0.97 * (p.z + 0.6));
    }
    EXPECT_EQ(field.clearance({0.6, 0, 0}), 0);
    EXPECT_EQ(field.clearance({0, 0, -0.51}), 0);
    EXPECT_EQ(field.clearance({NAN, 0, 0}), 0);
}

TEST(ClearanceField, IsTheSameInAUnitThatIsAPowerOfTwo)
{
    const Imath::Box3d box(V3d(-1.1), V3d(1.3, 1.2, 1.1));
    const Mesh mesh = join(make(icosphere(3)), needles(100));
    for (const double scale : {0x1p20, 0x1p-40}) {
        Mesh other = mesh;
        for (V3f& p : other.positions) p *= static_cast<float>(scale);
        const std::vector<TriangleView> a{mesh.view()}, b{other.view()};
        const ClearanceField fa(a, box, Progress()), fb(b, {box.min * scale, box.max * scale}, Progress());
        std::mt19937_64 random(1);
        std::uniform_real_distribution<double> uniform(-1.1, 1.1), exponent(-6, 0);
        for (int i = 0; i < 20000; ++i) {
            V3d p(uniform(random), uniform(random), uniform(random));
            if (i % 2 == 0) p = random_direction(random) * (1 - std::pow(10, exponent(random)));
            ASSERT_EQ(fa.clearance(p) * scale, fb.clearance(p * scale));
        }
    }
}

TEST(ClearanceField, AnswersManyThreadsAlike)
{
    const Imath::Box3d box(V3d(-1.1), V3d(1.1));
    const Mesh mesh = join(make(icosphere(4)), random_triangles(2000, 0.3, 0.02, 6));
    const std::vector<TriangleView> view{mesh.view()};
    const ClearanceField alone(view, box, Progress()), shared(view, box, Progress());
    std::vector<V3d> places;
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> exponent(-6, -0.3);
    for (int i = 0; i < 20000; ++i) places.push_back(random_direction(random) * (1 - std::pow(10, exponent(random))));
    std::vector<std::vector<double>> found(8, std::vector<double>(places.size()));
    std::vector<std::thread> threads;
    for (size_t t = 0; t < found.size(); ++t)
        threads.emplace_back([&, t] {
            // Threads query in different orders, but the first queries at the same time.
            for (size_t i = 0; i < places.size(); ++i) {
                const size_t at = t % 2 ? i : (i * 7 + t * 1000) % places.size();
                found[t][at] = shared.clearance(places[at]);
            }
        });
    for (std::thread& t : threads) t.join();
    for (size_t i = 0; i < places.size(); ++i)
        for (const auto& f : found) ASSERT_EQ(f[i], alone.clearance(places[i]));
}

TEST(ClearanceField, TakesNoTrianglesFlatBoxesAndTrianglesWithoutArea)
{
    EXPECT_EQ(ClearanceField().clearance(V3d(0)), 0);
    const Imath::Box3d box(V3d(-1), V3d(1));
    const ClearanceField nothing({}, box, Progress());
    EXPECT_EQ(nothing.clearance(V3d(0.1)), INFINITY);
    EXPECT_EQ(nothing.clearance(V3d(2)), 0);
    const Mesh needle{{V3f(-0.9f, 0, 0), V3f(0.9f, 0.1f, 0.2f), V3f(-0.9f, 0, 0)}, {{0, 1, 2}}};
    check({needle}, box, 3000);
    const std::vector<TriangleView> view{needle.view()};
    const ClearanceField flat(view, {V3d(-1, -1, 0), V3d(1, 1, 0)}, Progress());
    const double truth = distance(needle, {0, -0.9, 0});
    EXPECT_GT(flat.clearance({0, -0.9, 0}), 0.97 * truth);
    EXPECT_LE(flat.clearance({0, -0.9, 0}), truth);
}

TEST(ClearanceField, RefusesWhatItCannotHold)
{
    const Imath::Box3d box(V3d(-1), V3d(1));
    EXPECT_THROW(ClearanceField({}, box, Progress(), 0), InputError);
    EXPECT_THROW(ClearanceField({}, Imath::Box3d(), Progress()), InputError);
    EXPECT_THROW(ClearanceField({}, {V3d(0x1p60), V3d(0x1p60 * (1 + 0x1p-51))}, Progress()), InputError);
    const Mesh away{{V3f(0), V3f(0x1p110f), V3f(1)}, {{0, 1, 2}}};
    EXPECT_THROW(ClearanceField(std::vector<TriangleView>{away.view()}, box, Progress()), InputError);
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
