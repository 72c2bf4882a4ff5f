#include "render/medium/grid_medium_build.h"

#include "ingest/support/error.h"
#include "tests/builders/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace scree {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A grid of n^3 voxels, voxel (i, j, k) at h (i, j, k) + shift.
FloatGrid::Ptr make_grid(int n, double h, const V3d& shift, const std::function<double(int, int, int)>& density)
{
    openvdb::initialize();
    auto grid = FloatGrid::create(0);
    auto transform = openvdb::math::Transform::createLinearTransform(h);
    transform->postTranslate(openvdb::Vec3d(shift.x, shift.y, shift.z));
    grid->setTransform(transform);
    auto accessor = grid->getAccessor();
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) accessor.setValue(Coord(i, j, k), static_cast<float>(density(i, j, k)));
    return grid;
}

GridMedium make_medium(openvdb::GridBase::ConstPtr density, const GridMediumOptions& options = {}, const RenderSpace& space = {})
{
    MediumGrids grids;
    grids.density = std::move(density);
    return make_grid_medium(grids, options, space, {});
}

struct Ray {
    V3d o, d;
    double t0 = 0, t1 = infinity;
};

/// The optical depth by the midpoint rule over what sigma_t() tells, in n pieces.
double optical_depth(const GridMedium& medium, const Ray& ray, double t0, double t1, int n)
{
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += double{medium.sigma_t(ray.o + ray.d * (t0 + (t1 - t0) * (i + 0.5) / n)).x};
    return sum * (t1 - t0) / n;
}

/// Estimates by both walks agree with a known optical depth within 4 standard errors, the variance of the event's chance being known.
void expect_depth(const GridMedium& medium, const Ray& ray, double depth, uint32_t n, uint64_t seed = 1)
{
    const double truth = std::exp(-depth);
    Estimate ratio;
    double passed = 0;
    for (uint32_t i = 0; i < n; ++i) {
        Sampler sampler(seed, i, 0, 0);
        SpectralState state;
        const MediumEvent event = medium.event(ray.o, ray.d, ray.t0, ray.t1, state, sampler);
        passed += event.scattered ? 0 : 1;
        if (event.scattered) {
            EXPECT_GE(event.t, ray.t0);
            EXPECT_LE(event.t, ray.t1);
        }
        ratio.add(double{medium.transmittance(ray.o, ray.d, ray.t0, ray.t1, sampler).x});
    }
    // Where the estimate has no scatter at all, only the rounding of floats is left.
    EXPECT_LT(std::abs(ratio.mean() - truth), 4 * ratio.standard_error() + 2e-7) << "transmittance " << ratio.mean() << " of " << truth;
    EXPECT_LT(std::abs(passed / n - truth), 4 * std::sqrt(truth * (1 - truth) / n) + 1e-12) << "passed " << passed / n << " of " << truth;
}

constexpr int edge = 40;

/// A ramp along x; the exact integral of a linear density along any segment is its mean times the length.
TEST(GridMedium, LinearRamp)
{
    const double h = 0.05;
    const GridMedium medium = make_medium(make_grid(edge, h, V3d(-1), [](int i, int, int) { return 0.1 * i; }));
    // Density 0.1 (x + 1) / h inside of the voxels' centres: -1..0.95.
    const auto density = [&](double x) { return 0.1 * (x + 1) / h; };
    const V3d a(-0.93, -0.7, -0.6), b(0.9, 0.5, 0.8);
    const V3d d = (b - a).normalized();
    const double length = (b - a).length();
    expect_depth(medium, {a, d, 0, length}, 0.5 * (density(a.x) + density(b.x)) * length, 40000);
    expect_depth(medium, {b, -d, 0.2, length}, 0.5 * (density(a.x) + density(b.x - 0.2 * d.x)) * (length - 0.2), 40000);
    EXPECT_NEAR(medium.largest_sigma_t(), 3.9, 1e-6);
}

/// 1 + sin(k x), on a grid: between voxels linear in x, so that along x the exact depth is the trapezoid rule's.
TEST(GridMedium, Sinusoidal)
{
    const double h = 0.05, k = 2 * pi / 0.7;
    const auto value = [&](int i) { return 1 + std::sin(k * (i * h - 1)); };
    const GridMedium medium = make_medium(make_grid(edge, h, V3d(-1), [&](int i, int, int) { return value(i); }));
    double depth = 0;
    for (int i = 0; i < edge; ++i) depth += h * double{static_cast<float>(value(i))};
    // With the ramps from and to 0 outside of the first and the last voxel.
    expect_depth(medium, {{-3, 0.1, 0.2}, {1, 0, 0}}, depth, 100000);
    // And the continuous field itself, sampled finely enough: its interpolant is (kh)^2 / 12 lower in amplitude, below the standard error.
    const int fine = 200;
    const double hf = 1.0 / fine;
    auto grid = make_grid(2, hf, V3d(0), [](int, int, int) { return 0; });
    grid->clear();
    auto accessor = grid->getAccessor();
    for (int i = 0; i <= fine; ++i)
        for (int j = 0; j < 3; ++j)
            for (int l = 0; l < 3; ++l) accessor.setValue(Coord(i, j, l), static_cast<float>(2 + 2 * std::sin(k * i * hf)));
    expect_depth(make_medium(grid), {{0, hf, hf}, {1, 0, 0}, 0, 1}, 2 - 2 / k * (std::cos(k) - 1), 100000);
}

/// Checkered voxels, constant each: what a ray crosses is counted exactly.
TEST(GridMedium, CheckeredNearest)
{
    const double h = 0.05;
    GridMediumOptions options;
    options.nearest = true;
    options.scale = C3f(1.5f);
    const GridMedium medium = make_medium(make_grid(edge, h, V3d(-1), [](int i, int j, int k) { return (i + j + k) % 2 ? 2.0 : 0.0; }), options);
    // Along an axis half of the voxels; along the diagonal of x and y, through the middles of edges' faces: always the same parity.
    expect_depth(medium, {{-3, 0.012, 0.013}, {1, 0, 0}}, 1.5 * 2 * h * edge / 2, 40000);
    const V3d o(-1.0 - 2 * h, -1.0 - 2 * h, 0.01);
    const double diagonal = edge * h * std::sqrt(2.0);
    const int k = static_cast<int>(std::lround((0.01 + 1) / h));
    expect_depth(medium, {o, V3d(1, 1, 0).normalized()}, k % 2 ? 1.5 * 2 * diagonal : 0, 20000);
    // A generic direction: against fine steps through sigma_t(), error at most some 60 faces of half a step.
    const Ray ray{{-1.5, -0.8, -0.9}, V3d(1.0, 0.6, 0.7).normalized(), 0, 4};
    expect_depth(medium, ray, optical_depth(medium, ray, 0, 4, 4000000), 40000);
}

/// Trilinear, uneven, sparse: against fine midpoint sums, along generic rays, axes and faces of voxels and bricks.
TEST(GridMedium, AnyRayThroughASparseGrid)
{
    const double h = 0.05;
    for (const bool nearest : {false, true}) {
        GridMediumOptions options;
        options.nearest = nearest;
        options.scale = C3f(3);
        const GridMedium medium = make_medium(make_grid(edge, h, V3d(-1), [](int i, int j, int k) {
            const int cell = (i / 7) * 31 + (j / 5) * 17 + (k / 6) * 7;
            return cell % 3 == 0 ? 0.2 * ((i * 3 + j * 5 + k * 7) % 11) : 0.0;
        }), options);
        std::vector<Ray> rays;
        for (uint32_t i = 0; i < 6; ++i) {
            Sampler sampler(3, i, 0, 0);
            const auto draw = [&] { return V3d(2 * sampler.next() - 1, 2 * sampler.next() - 1, 2 * sampler.next() - 1); };
            rays.push_back({draw(), draw().normalized(), 0.1 * sampler.next(), 0.4 + sampler.next()});
        }
        const double face = -1 + 8 * h; // a brick's, as exactly as doubles have it
        rays.push_back({{-2, face, 0.1}, {1, 0, 0}, 0, 4});
        rays.push_back({{0.1, face, 2}, {0, 0, -1}, 0, 4});
        rays.push_back({{face, face, -2}, {0, 0, 1}, 0, 4});
        rays.push_back({{face, face, face}, V3d(1, 1, 1).normalized(), 0, 4});
        rays.push_back({{face, face, face}, V3d(-1, 1, -1).normalized(), 0, 4});
        rays.push_back({{face, -0.2, 0.3}, {-1e-300, 1, 1e-320}, 0, 4});
        for (const Ray& ray : rays) {
            // Where a voxel's face holds the whole ray, a nearest voxel is not defined.
            if (nearest && (ray.d.x == 0 || ray.d.y == 0 || ray.d.z == 0 || std::abs(ray.d.x) == std::abs(ray.d.y))) continue;
            SCOPED_TRACE(testing::Message() << "ray from " << ray.o << " along " << ray.d << (nearest ? ", nearest" : ""));
            expect_depth(medium, ray, optical_depth(medium, ray, ray.t0, std::min(ray.t1, 5.0), 200000), 10000, 5);
        }
    }
}

/// The free flights' distribution: chi-square over 40 cells of equal chance, p above 1e-4.
TEST(GridMedium, FreeFlights)
{
    const double h = 0.05;
    for (const float scale : {1.0f, 30.0f, 1000.0f}) { // delta tracking, both, and closed form
        GridMediumOptions options;
        options.scale = C3f(scale);
        const GridMedium medium = make_medium(make_grid(edge, h, V3d(-1), [](int i, int j, int k) { return ((i / 4 + j / 3 + k / 5) % 3) * 0.5; }), options);
        const Ray ray{{-1.2, -0.9, -0.8}, V3d(1.0, 0.7, 0.8).normalized(), 0, 4};
        constexpr int fine = 400000;
        std::vector<double> passed(fine + 1, 0); // transmittance at steps of the ray
        double depth = 0;
        for (int i = 0; i < fine; ++i) {
            const double t = ray.t1 * (i + 0.5) / fine;
            depth += double{medium.sigma_t(ray.o + ray.d * t).x} * ray.t1 / fine;
            passed[static_cast<size_t>(i) + 1] = -std::expm1(-depth);
        }
        constexpr uint32_t n = 40000;
        constexpr size_t cells = 40;
        std::vector<double> observed(cells + 1, 0), expected(cells + 1, n * passed.back() / cells);
        expected[cells] = n * (1 - passed.back());
        for (uint32_t i = 0; i < n; ++i) {
            Sampler sampler(11, i, 0, 0);
            SpectralState state;
            const MediumEvent event = medium.event(ray.o, ray.d, ray.t0, ray.t1, state, sampler);
            if (!event.scattered) {
                observed[cells] += 1;
                continue;
            }
            const double place = event.t / ray.t1 * fine;
            const size_t at = std::min(static_cast<size_t>(place), size_t{fine} - 1);
            const double p = passed[at] + (place - static_cast<double>(at)) * (passed[at + 1] - passed[at]);
            observed[std::min(cells - 1, static_cast<size_t>(p / passed.back() * cells))] += 1;
        }
        const ChiSquare test = chi_square(observed, expected);
        EXPECT_GT(test.p_value, 1e-4) << "scale " << scale << "\n" << test.text;
    }
}

/// One voxel a million times denser than the rest: right beside it, grazing it and through it.
TEST(GridMedium, OneDenseVoxel)
{
    const double h = 0.05;
    const auto make = [&](double dense) {
        return make_medium(make_grid(edge, h, V3d(-1), [&](int i, int j, int k) { return i == 20 && j == 20 && k == 20 ? dense : 1.0; }));
    };
    const GridMedium medium = make(1e6);
    const V3d d = V3d(1, 0.02, 0.01).normalized();
    const double y = -1 + 22.5 * h; // two and a half voxels beside: the same brick, but out of the voxel's reach
    const Ray beside{{-0.9, y, y}, d, 0, 1.5};
    expect_depth(medium, beside, 1.5, 40000);
    // Through the ramp of its neighbours, far from its middle: density 1 + 1e6 (1 - |x|/h) w.
    const double w = 1e-5;
    const V3d grazing(-0.9, -1 + 20 * h, -1 + (21 - w) * h);
    expect_depth(medium, {grazing, {1, 0, 0}, 0, 1.5}, 1.5 + (1e6 - 1) * w * h, 40000);
    Sampler sampler(1, 0, 0, 0);
    SpectralState state;
    const MediumEvent hit = medium.event({-0.9, -1 + 20 * h, -1 + 20 * h}, {1, 0, 0}, 0.85, 2, state, sampler);
    EXPECT_TRUE(hit.scattered);
    EXPECT_LT(hit.t, 0.95);
}

/// Along a cell's diagonal towards one dense voxel the density is D s^3, so that exp(-D sqrt(3) s^4 / 4) of the flights is uniform
/// in 0..1: mean 1/2 and mean square 1/3 within 4 standard errors.
TEST(GridMedium, FlightsUpACubicRamp)
{
    const double dense = 200;
    const GridMedium medium = make_medium(make_grid(24, 1, V3d(0), [&](int i, int j, int k) { return i == 12 && j == 12 && k == 12 ? dense : 0.0; }));
    Estimate first, second;
    for (uint32_t i = 0; i < 40000; ++i) {
        Sampler sampler(9, i, 0, 0);
        SpectralState state;
        const MediumEvent event = medium.event(V3d(11.0), V3d(1).normalized(), 0, infinity, state, sampler);
        ASSERT_TRUE(event.scattered);
        const double s = event.t / std::sqrt(3.0), u = std::exp(-dense * std::sqrt(3.0) * s * s * s * s / 4);
        first.add(u);
        second.add(u * u);
    }
    EXPECT_LT(std::abs(first.z(0.5)), 4);
    EXPECT_LT(std::abs(second.z(1.0 / 3)), 4);
}

/// Densities from 1e-12 to 1e12, constant and uneven: chances are right and every walk ends.
TEST(GridMedium, ExtremeDensities)
{
    const double h = 0.05;
    for (const double sigma : {1e-12, 1e-6, 1e3, 1e12}) {
        GridMediumOptions options;
        options.scale = C3f(static_cast<float>(sigma));
        const double s = double{options.scale.x};
        for (const bool even : {true, false}) {
            const GridMedium medium = make_medium(make_grid(24, h, V3d(0), [&](int i, int j, int k) { return even ? 1.0 : ((i + j + k) % 4) / 3.0; }), options);
            Estimate chance;
            for (uint32_t i = 0; i < 4000; ++i) {
                Sampler sampler(2, i, 0, 0);
                SpectralState state;
                // From well inside, and from outside through the ramp of the first voxels.
                const MediumEvent inside = medium.event({0.5, 0.5, 0.5}, V3d(1, 0.3, 0.2).normalized(), 0, infinity, state, sampler);
                const MediumEvent outside = medium.event({-1, 0.5, 0.51}, V3d(1, 0.03, 0.02).normalized(), 0, infinity, state, sampler);
                chance.add(inside.scattered);
                EXPECT_EQ(outside.scattered, sigma > 1 ? true : outside.scattered);
                const double t = double{medium.transmittance({-1, 0.5, 0.51}, V3d(1, 0.03, 0.02).normalized(), 0, infinity, sampler).x};
                ASSERT_TRUE(t >= 0 && t <= 1);
                if (sigma > 1) { ASSERT_LT(t, 0.11); }
            }
            if (sigma > 1) EXPECT_EQ(chance.mean(), 1);
            else EXPECT_LE(chance.mean(), 4e-3); // chance below 1e-6 each
            if (even && sigma > 1) {
                // Mean free path in the constant part: 4 standard errors of the mean of exponentials.
                Estimate flight;
                for (uint32_t i = 0; i < 4000; ++i) {
                    Sampler sampler(4, i, 0, 0);
                    SpectralState state;
                    flight.add(medium.event({0.2, 0.5, 0.5}, {1, 0, 0}, 0, infinity, state, sampler).t);
                }
                EXPECT_LT(std::abs(flight.z(1 / s)), 4);
            }
        }
    }
}

TEST(GridMedium, ThinMediaScatterAsRarelyAsTheyShould)
{
    // 4,000,000 walks at a depth of 8e-6: 32 events, standard error 5.7.
    GridMediumOptions options;
    options.scale = C3f(1e-6f);
    options.nearest = true;
    const GridMedium medium = make_medium(make_grid(8, 1.0, V3d(0), [](int, int, int) { return 1.0; }), options);
    int events = 0;
    for (uint32_t i = 0; i < 4000000; ++i) {
        Sampler sampler(2, i, 0, 0);
        SpectralState state;
        events += medium.event({-0.5, 3, 3}, {1, 0, 0}, 0, 8, state, sampler).scattered;
    }
    EXPECT_LT(std::abs(events - 32), 4 * std::sqrt(32.0));
}

TEST(GridMedium, NothingInAnEmptyGrid)
{
    for (const GridMedium& medium : {make_medium(FloatGrid::create(0)), make_medium(make_grid(10, 1, V3d(0), [](int, int, int) { return 0.0; })), [] {
             GridMediumOptions none;
             none.scale = C3f(0);
             return make_medium(make_grid(10, 1, V3d(0), [](int, int, int) { return 1.0; }), none);
         }()}) {
        Sampler sampler(1, 0, 0, 0);
        SpectralState state;
        EXPECT_FALSE(medium.event({-5, 5, 5}, {1, 0, 0}, 0, infinity, state, sampler).scattered);
        EXPECT_EQ(medium.transmittance({-5, 5, 5}, {1, 0, 0}, 0, infinity, sampler), C3f(1));
        EXPECT_EQ(medium.largest_sigma_t(), 0);
        EXPECT_TRUE(medium.is_achromatic());
    }
    EXPECT_TRUE(make_medium(FloatGrid::create(0)).bounds().isEmpty());
}

/// Rays that are not numbers, or go nowhere, end.
TEST(GridMedium, RaysThatAreNone)
{
    const GridMedium medium = make_medium(make_grid(20, 0.1, V3d(0), [](int i, int, int) { return i % 2 + 0.5; }));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const V3d& bad : {V3d(nan, 0, 0), V3d(infinity, 1, 0), V3d(0, 0, 0)}) {
        Sampler sampler(1, 0, 0, 0);
        SpectralState state;
        EXPECT_FALSE(medium.event({1, 1, 1}, bad, 0, infinity, state, sampler).scattered);
        EXPECT_EQ(medium.transmittance({1, 1, 1}, bad, 0, infinity, sampler), C3f(1));
    }
    Sampler sampler(1, 0, 0, 0);
    SpectralState state;
    EXPECT_FALSE(medium.event({1, 1, 1}, {1, 0, 0}, 2, 1, state, sampler).scattered);
    EXPECT_FALSE(medium.event({1, 1, 1}, {1, 0, 0}, 5, infinity, state, sampler).scattered);
}

/// A scene scaled by 2^k gives the same walks, bit for bit; one scaled by 1e-6 or 1e6, the same numbers but for rounding.
TEST(GridMedium, Scaling)
{
    const auto density = [](int i, int j, int k) { return ((i / 4 + j / 3 + k / 5) % 3) * 0.5; };
    const auto flights = [&](double scale, int exponent) {
        MediumGrids grids;
        grids.density = make_grid(edge, 0.05, V3d(-1, -0.7, 3), density);
        grids.to_scene.setScale(V3d(scale));
        GridMediumOptions options;
        options.scale = C3f(static_cast<float>(2 / scale));
        RenderSpace space;
        space.origin = V3d(0.1, 0.2, 4) * scale;
        space.exponent = exponent;
        const GridMedium medium = make_grid_medium(grids, options, space, {});
        std::vector<double> result;
        for (uint32_t i = 0; i < 2000; ++i) {
            Sampler sampler(7, i, 0, 0);
            SpectralState state;
            const double length = space.length(scale);
            const V3d o = V3d(-2, 0.1 * sampler.next(), 0.2) * length, d = V3d(1, sampler.next() - 0.5, sampler.next() - 0.5).normalized();
            const MediumEvent event = medium.event(o, d, 0, infinity, state, sampler);
            result.push_back(event.t / length);
            result.push_back(double{medium.transmittance(o, d, 0, infinity, sampler).x});
        }
        return result;
    };
    const std::vector<double> one = flights(1, 0);
    EXPECT_EQ(flights(0x1p-20, -20), one);
    EXPECT_EQ(flights(0x1p20, 20), one);
    EXPECT_EQ(flights(0x1p3, -2), one);
    for (const double scale : {1e-6, 1e6}) {
        const std::vector<double> scaled = flights(scale, static_cast<int>(std::lround(std::log2(scale))));
        size_t different = 0;
        for (size_t i = 0; i < one.size(); ++i) different += std::abs(scaled[i] - one[i]) > 1e-5;
        EXPECT_LE(different, one.size() / 1000) << scale; // a decision may turn over
    }
}

/// A constant chromatic medium: spectral MIS gives 1 - exp(-tau) and exp(-tau) in every channel; with absorption over many
/// events the albedo of a walk along a line.
TEST(GridMedium, ChromaticClosedForms)
{
    const double h = 0.05;
    // Constant bricks; uneven ones by delta tracking; dense uneven ones in closed form.
    struct Case {
        C3f scale;
        bool uneven;
    };
    for (const Case& c : {Case{{0.5f, 1.0f, 2.0f}, false}, Case{{0.0f, 1.0f, 3.0f}, false}, Case{{0.5f, 1.0f, 2.0f}, true}, Case{{300, 700, 900}, true}}) {
        GridMediumOptions options;
        options.scale = c.scale;
        const GridMedium medium = make_medium(make_grid(edge, h, V3d(-1), [&](int i, int j, int k) { return c.uneven ? ((i + j + k) % 3) * 0.5 : 1.0; }), options);
        ASSERT_FALSE(medium.is_achromatic());
        const double length = c.scale.z > 100 ? 0.008 : 0.8;
        const Ray ray{{-0.703, -0.3, -0.2}, V3d(1, 0.4, 0.3).normalized(), 0, length};
        std::array<Estimate, 3> scattered, passed, transmitted;
        for (uint32_t i = 0; i < 60000; ++i) {
            Sampler sampler(5, i, 0, 0);
            SpectralState state;
            state.hero = std::min(2u, static_cast<uint32_t>(3 * sampler.next()));
            const MediumEvent event = medium.event(ray.o, ray.d, ray.t0, ray.t1, state, sampler);
            const double mean = (double{state.ratio.x} + double{state.ratio.y} + double{state.ratio.z}) / 3;
            const C3f t = medium.transmittance(ray.o, ray.d, ray.t0, ray.t1, sampler);
            for (int k = 0; k < 3; ++k) {
                const size_t at = static_cast<size_t>(k);
                const double weight = double{state.weight[k]} / mean;
                scattered[at].add(event.scattered ? weight : 0);
                passed[at].add(event.scattered ? 0 : weight);
                transmitted[at].add(double{t[k]});
            }
        }
        // sigma_t of a channel is its scale times one field: take the field from the largest, which is never 0.
        double depth_of_one = 0;
        for (int i = 0; i < 200000; ++i) depth_of_one += double{medium.sigma_t(ray.o + ray.d * (length * (i + 0.5) / 200000)).z} / double{c.scale.z} * length / 200000;
        for (int k = 0; k < 3; ++k) {
            const size_t at = static_cast<size_t>(k);
            const double truth = std::exp(-depth_of_one * double{c.scale[k]});
            SCOPED_TRACE(testing::Message() << "channel " << k << " of scale " << c.scale << (c.uneven ? ", uneven" : ""));
            EXPECT_LT(std::abs(scattered[at].mean() - (1 - truth)), 4 * scattered[at].standard_error() + 1e-6);
            EXPECT_LT(std::abs(passed[at].mean() - truth), 4 * passed[at].standard_error() + 1e-6);
            EXPECT_LT(std::abs(transmitted[at].mean() - truth), 4 * transmitted[at].standard_error() + 1e-6);
        }
    }
}

/// A path of up to n events straight on, counted by the albedo: the sum over all orders is exp(-(1 - a) tau) escaped light per channel.
TEST(GridMedium, ChromaticPathsWithAlbedo)
{
    GridMediumOptions options;
    options.scale = C3f(1, 2, 4);
    options.albedo = C3f(0.9f, 0.7f, 0.5f);
    const GridMedium medium = make_medium(make_grid(edge, 0.05, V3d(-1), [](int i, int j, int k) { return 0.3 + ((i + 2 * j + k) % 5) * 0.3; }), options);
    const Ray ray{{-0.8, -0.3, -0.4}, V3d(1, 0.3, 0.4).normalized(), 0, 1};
    double depth = 0;
    for (int i = 0; i < 200000; ++i) depth += double{medium.sigma_t(ray.o + ray.d * ((i + 0.5) / 200000)).x} / 200000;
    std::array<Estimate, 3> escaped;
    for (uint32_t i = 0; i < 60000; ++i) {
        Sampler sampler(6, i, 0, 0);
        SpectralState state;
        state.hero = std::min(2u, static_cast<uint32_t>(3 * sampler.next()));
        double t = 0;
        for (;;) {
            const MediumEvent event = medium.event(ray.o, ray.d, t, 1, state, sampler);
            if (!event.scattered) break;
            state.weight *= event.albedo;
            t = event.t;
        }
        const double mean = (double{state.ratio.x} + double{state.ratio.y} + double{state.ratio.z}) / 3;
        for (int k = 0; k < 3; ++k) escaped[static_cast<size_t>(k)].add(double{state.weight[k]} / mean);
    }
    for (int k = 0; k < 3; ++k)
        EXPECT_LT(std::abs(escaped[static_cast<size_t>(k)].z(std::exp(-(1 - double{options.albedo[k]}) * double{options.scale[k]} * depth))), 4) << "channel " << k;
}

/// A grid of vectors as density is the same as three channels.
TEST(GridMedium, VectorsOfDensity)
{
    openvdb::initialize();
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0));
    auto accessor = grid->getAccessor();
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            for (int k = 0; k < 20; ++k) accessor.setValue(Coord(i, j, k), openvdb::Vec3s(0.02f * static_cast<float>(i), 0.01f * static_cast<float>(j), 0.1f));
    const GridMedium medium = make_medium(grid);
    EXPECT_FALSE(medium.is_achromatic());
    const V3d a(3, 2.5, 4), b(17, 15, 11);
    const V3d d = (b - a).normalized();
    const double length = (b - a).length();
    const V3d depth(0.02 * 10 * length, 0.01 * 8.75 * length, 0.1 * length);
    std::array<Estimate, 3> passed, transmitted;
    for (uint32_t i = 0; i < 60000; ++i) {
        Sampler sampler(8, i, 0, 0);
        SpectralState state;
        state.hero = std::min(2u, static_cast<uint32_t>(3 * sampler.next()));
        const bool scattered = medium.event(a, d, 0, length, state, sampler).scattered;
        const double mean = (double{state.ratio.x} + double{state.ratio.y} + double{state.ratio.z}) / 3;
        const C3f t = medium.transmittance(a, d, 0, length, sampler);
        for (int k = 0; k < 3; ++k) {
            passed[static_cast<size_t>(k)].add(scattered ? 0 : double{state.weight[k]} / mean);
            transmitted[static_cast<size_t>(k)].add(double{t[k]});
        }
    }
    for (int k = 0; k < 3; ++k) {
        EXPECT_LT(std::abs(passed[static_cast<size_t>(k)].z(std::exp(-depth[k]))), 4) << "channel " << k;
        EXPECT_LT(std::abs(transmitted[static_cast<size_t>(k)].z(std::exp(-depth[k]))), 4) << "channel " << k;
    }
}

/// Tiles of the tree are regions as they are: a large box costs no more than its faces.
TEST(GridMedium, TilesStaySmall)
{
    openvdb::initialize();
    auto grid = FloatGrid::create(0);
    grid->fill(openvdb::CoordBBox(Coord(0), Coord(511)), 0.001f);
    const GridMedium medium = make_medium(grid);
    EXPECT_LT(medium.bytes(), 90u << 20); // 6 (64 + 1)^2 bricks at the faces, of 2.9 kB; in full 0.8 GB
    EXPECT_EQ(medium.bounds(), Imath::Box3d(V3d(-1), V3d(512)));
    expect_depth(medium, {{-50, 200.3, 300.7}, V3d(1, 0.1, 0.2).normalized(), 100, 500}, 0.4, 40000);
    // Far voxels make no table between them.
    auto far = FloatGrid::create(0);
    for (const int x : {-4000000, 0, 4000000}) far->fill(openvdb::CoordBBox(Coord(x), Coord(x + 7)), 0.05f);
    const GridMedium sparse = make_medium(far);
    EXPECT_LT(sparse.bytes(), 2u << 20);
    // Cells 0..7 and the ramps beside: 8 voxels' worth of density.
    expect_depth(sparse, {{-1000, 3, 3}, {1, 0, 0}}, 0.4, 100000);
    // Along the diagonal the ramps are cubic.
    const V3d d = V3d(1, 1, 1).normalized();
    expect_depth(sparse, {V3d(-4000100.0), d}, 3 * (7 * 0.05 + 2 * 0.05 / 4) * std::sqrt(3.0), 100000);
}

/// Albedo and g on grids of their own, coarser than the density; beside their faces no background is mixed in.
TEST(GridMedium, AlbedoAndAsymmetryGrids)
{
    openvdb::initialize();
    MediumGrids grids;
    grids.density = make_grid(20, 0.1, V3d(0), [](int, int, int) { return 1.0; });
    auto albedo = openvdb::Vec3SGrid::create(openvdb::Vec3s(0));
    albedo->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    auto accessor = albedo->getAccessor();
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
            for (int k = 0; k < 5; ++k) accessor.setValue(Coord(i, j, k), openvdb::Vec3s(0.2f * static_cast<float>(i), 0.5f, 0.9f));
    grids.albedo = albedo;
    grids.g = make_grid(20, 0.1, V3d(0), [](int, int j, int) { return 0.04 * j - 0.5; });
    const GridMedium medium = make_grid_medium(grids, {}, {}, {});
    const C3f a = medium.albedo({0.75, 1, 1});
    EXPECT_NEAR(a.x, 0.3f, 1e-6f);
    EXPECT_NEAR(a.y, 0.5f, 1e-6f);
    EXPECT_NEAR(medium.albedo({1, 1, -0.05}).z, 0.9f, 1e-6f);
    EXPECT_NEAR(medium.g({1, 0.55, 1}), 0.04 * 5.5 - 0.5, 1e-6);
    EXPECT_NEAR(medium.g({1, -0.05, 1}), -0.5, 1e-6);
    Sampler sampler(1, 0, 0, 0);
    SpectralState state;
    const MediumEvent event = medium.event({1, 0.55, 1}, {0, 0, 1}, 0, infinity, state, sampler);
    if (event.scattered) { EXPECT_NEAR(event.g, 0.04 * 5.5 - 0.5, 1e-6); }
}

/// A rotated, sheared, mirrored and shifted grid: places are where its transform puts them.
TEST(GridMedium, AffineTransforms)
{
    auto grid = make_grid(20, 1, V3d(0), [](int i, int j, int k) { return 0.01 * i + 0.02 * j + 0.03 * k; });
    const openvdb::Mat4d m(0.3, 0.1, 0.0, 0.0, -0.2, 0.25, 0.05, 0.0, 0.02, 0.1, -0.4, 0.0, 5.0, -7.0, 11.0, 1.0);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(m));
    RenderSpace space;
    space.origin = V3d(5, -6, 10);
    space.exponent = 2;
    const GridMedium medium = make_medium(grid, {}, space);
    const openvdb::Vec3d voxel(7.3, 4.6, 11.9);
    const openvdb::Vec3d world = grid->indexToWorld(voxel);
    EXPECT_NEAR(medium.sigma_t(space.point(V3d(world.x(), world.y(), world.z()))).x, 4 * (0.073 + 0.092 + 0.357), 1e-5);
    const openvdb::Vec3d end = grid->indexToWorld(openvdb::Vec3d(15.1, 9.2, 3.3));
    const V3d a = space.point(V3d(world.x(), world.y(), world.z())), b = space.point(V3d(end.x(), end.y(), end.z()));
    const double length = (b - a).length();
    expect_depth(medium, {a, (b - a) / length, 0, length}, 4 * 0.5 * (0.073 + 0.092 + 0.357 + 0.151 + 0.184 + 0.099) * length, 40000);
    for (int corner = 0; corner < 8; ++corner) {
        const openvdb::Vec3d p = grid->indexToWorld(openvdb::Vec3d(corner & 1 ? 19 : 1, corner & 2 ? 19 : 1, corner & 4 ? 19 : 1));
        EXPECT_TRUE(medium.bounds().intersects(space.point(V3d(p.x(), p.y(), p.z()))));
    }
}

TEST(GridMedium, WalksAreTheSameWhateverTheyStartFrom)
{
    // A ray cut in two has the same transmittance, and its origin far back along the same line too.
    const GridMedium medium = make_medium(make_grid(edge, 0.05, V3d(-1), [](int i, int j, int k) { return ((i / 4 + j / 3 + k / 5) % 3) * 0.5; }));
    const V3d d = V3d(1, 0.6, 0.4).normalized(), o(-0.9, -0.5, -0.5);
    const double depth = optical_depth(medium, {o, d}, 0.3, 1.4, 200000);
    expect_depth(medium, {o, d, 0.3, 1.4}, depth, 40000);
    expect_depth(medium, {o - d * 1e5, d, 1e5 + 0.3, 1e5 + 1.4}, depth, 40000);
}

} // namespace
} // namespace scree
