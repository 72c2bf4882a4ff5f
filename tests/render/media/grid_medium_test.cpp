#include "tests/builders/statistics.h"
#include "tests/render/media/medium_grids.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using Ray = TestRay;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int edge = 40;

/// A ramp along x; the exact integral of a linear density along any segment is its mean times the length.
TEST(GridMedium, LinearRamp)
{
    const double h = 0.05;
    const GridMedium medium = make_medium(make_grid(edge, h, V3d(-1), [](int i, int, int) { return 0.1 * i; }));
    // Density 0.1 (x + 1) / h between the outermost voxel centres: -1..0.95.
    const auto density = [&](double x) { return 0.1 * (x + 1) / h; };
    const V3d a(-0.93, -0.7, -0.6), b(0.9, 0.5, 0.8);
    const V3d d = (b - a).normalized();
    const double length = (b - a).length();
    expect_depth(medium, {a, d, 0, length}, 0.5 * (density(a.x) + density(b.x)) * length, 40000);
    expect_depth(medium, {b, -d, 0.2, length}, 0.5 * (density(a.x) + density(b.x - 0.2 * d.x)) * (length - 0.2), 40000);
    EXPECT_NEAR(medium.largest_sigma_t(), 3.9, 1e-6);
}

/// 1 + sin(k x) on a grid: linear in x between voxels, so that the trapezoid rule gives the exact depth along x.
TEST(GridMedium, Sinusoidal)
{
    const double h = 0.05, k = 2 * pi / 0.7;
    const auto value = [&](int i) { return 1 + std::sin(k * (i * h - 1)); };
    const GridMedium medium = make_medium(make_grid(edge, h, V3d(-1), [&](int i, int, int) { return value(i); }));
    double depth = 0;
    for (int i = 0; i < edge; ++i) depth += h * double{static_cast<float>(value(i))};
    // Includes the ramps from and to 0 outside the first and the last voxel.
    expect_depth(medium, {{-3, 0.1, 0.2}, {1, 0, 0}}, depth, 100000);
    // And the continuous field itself, sampled finely enough: its interpolant is (kh)^2 / 12 lower in amplitude, below
    // the standard error.
    const int fine = 200;
    const double hf = 1.0 / fine;
    auto grid = make_grid(2, hf, V3d(0), [](int, int, int) { return 0; });
    grid->clear();
    auto accessor = grid->getAccessor();
    for (int i = 0; i <= fine; ++i)
        for (int j = 0; j < 3; ++j)
            for (int l = 0; l < 3; ++l)
                accessor.setValue(Coord(i, j, l), static_cast<float>(2 + 2 * std::sin(k * i * hf)));
    expect_depth(make_medium(grid), {{0, hf, hf}, {1, 0, 0}, 0, 1}, 2 - 2 / k * (std::cos(k) - 1), 100000);
}

/// A checkerboard of constant voxels: the voxels that a ray crosses can be counted exactly.
TEST(GridMedium, CheckeredNearest)
{
    const double h = 0.05;
    GridMediumOptions options;
    options.nearest = true;
    options.scale = Color(1.5f);
    const GridMedium medium = make_medium(
        make_grid(edge, h, V3d(-1), [](int i, int j, int k) { return (i + j + k) % 2 ? 2.0 : 0.0; }), options);
    // Along an axis half of the voxels; along the diagonal of x and y, through the middles of edges' faces: always the
    // same parity.
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
        options.scale = Color(3);
        const GridMedium medium =
            make_medium(make_grid(edge, h, V3d(-1),
                                  [](int i, int j, int k) {
                                      const int cell = (i / 7) * 31 + (j / 5) * 17 + (k / 6) * 7;
                                      return cell % 3 == 0 ? 0.2 * ((i * 3 + j * 5 + k * 7) % 11) : 0.0;
                                  }),
                        options);
        std::vector<Ray> rays;
        for (uint32_t i = 0; i < 6; ++i) {
            Sampler sampler(3, i, 0, 0);
            const auto draw = [&] {
                return V3d(2 * sampler.next() - 1, 2 * sampler.next() - 1, 2 * sampler.next() - 1);
            };
            rays.push_back({draw(), draw().normalized(), 0.1 * sampler.next(), 0.4 + sampler.next()});
        }
        const double face = -1 + 8 * h; // a brick's face, as exact as a double allows
        rays.push_back({{-2, face, 0.1}, {1, 0, 0}, 0, 4});
        rays.push_back({{0.1, face, 2}, {0, 0, -1}, 0, 4});
        rays.push_back({{face, face, -2}, {0, 0, 1}, 0, 4});
        rays.push_back({{face, face, face}, V3d(1, 1, 1).normalized(), 0, 4});
        rays.push_back({{face, face, face}, V3d(-1, 1, -1).normalized(), 0, 4});
        rays.push_back({{face, -0.2, 0.3}, {-1e-300, 1, 1e-320}, 0, 4});
        for (const Ray& ray : rays) {
            // If the ray lies in a voxel's face, its nearest voxel is not defined.
            if (nearest && (ray.d.x == 0 || ray.d.y == 0 || ray.d.z == 0 || std::abs(ray.d.x) == std::abs(ray.d.y)))
                continue;
            SCOPED_TRACE(testing::Message()
                         << "ray from " << ray.o << " along " << ray.d << (nearest ? ", nearest" : ""));
            expect_depth(medium, ray, optical_depth(medium, ray, ray.t0, std::min(ray.t1, 5.0), 200000), 10000, 5);
        }
    }
}

/// The distribution of free flights: chi-square over 40 cells of equal probability, p above 1e-4.
TEST(GridMedium, FreeFlights)
{
    const double h = 0.05;
    for (const float scale : {1.0f, 30.0f, 1000.0f}) { // delta tracking, both, and closed form
        GridMediumOptions options;
        options.scale = Color(scale);
        const GridMedium medium = make_medium(
            make_grid(edge, h, V3d(-1), [](int i, int j, int k) { return ((i / 4 + j / 3 + k / 5) % 3) * 0.5; }),
            options);
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

/// One voxel a million times denser than the rest: rays beside it, grazing it and through it.
TEST(GridMedium, OneDenseVoxel)
{
    const double h = 0.05;
    const auto make = [&](double dense) {
        return make_medium(make_grid(edge, h, V3d(-1),
                                     [&](int i, int j, int k) { return i == 20 && j == 20 && k == 20 ? dense : 1.0; }));
    };
    const GridMedium medium = make(1e6);
    const V3d d = V3d(1, 0.02, 0.01).normalized();
    const double y = -1 + 22.5 * h; // two and a half voxels aside: the same brick, but outside the voxel's influence
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

/// Along a cell's diagonal towards one dense voxel the density is D s^3, so that exp(-D sqrt(3) s^4 / 4) of the flights
/// is uniform in 0..1: mean 1/2 and mean square 1/3 within 4 standard errors.
TEST(GridMedium, FlightsUpACubicRamp)
{
    const double dense = 200;
    const GridMedium medium = make_medium(
        make_grid(24, 1, V3d(0), [&](int i, int j, int k) { return i == 12 && j == 12 && k == 12 ? dense : 0.0; }));
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

/// Densities from 1e-12 to 1e12, constant and uneven: probabilities are right and every walk ends.
TEST(GridMedium, ExtremeDensities)
{
    const double h = 0.05;
    for (const double sigma : {1e-12, 1e-6, 1e3, 1e12}) {
        GridMediumOptions options;
        options.scale = Color(static_cast<float>(sigma));
        const double s = double{options.scale.x};
        for (const bool even : {true, false}) {
            const GridMedium medium = make_medium(
                make_grid(24, h, V3d(0), [&](int i, int j, int k) { return even ? 1.0 : ((i + j + k) % 4) / 3.0; }),
                options);
            Estimate chance;
            for (uint32_t i = 0; i < 4000; ++i) {
                Sampler sampler(2, i, 0, 0);
                SpectralState state;
                // From well inside, and from outside through the ramp of the first voxels.
                const MediumEvent inside =
                    medium.event({0.5, 0.5, 0.5}, V3d(1, 0.3, 0.2).normalized(), 0, infinity, state, sampler);
                const MediumEvent outside =
                    medium.event({-1, 0.5, 0.51}, V3d(1, 0.03, 0.02).normalized(), 0, infinity, state, sampler);
                chance.add(inside.scattered);
                EXPECT_EQ(outside.scattered, sigma > 1 ? true : outside.scattered);
                const double t = double{
                    medium.transmittance({-1, 0.5, 0.51}, V3d(1, 0.03, 0.02).normalized(), 0, infinity, sampler).x};
                ASSERT_TRUE(t >= 0 && t <= 1);
                if (sigma > 1) {
                    ASSERT_LT(t, 0.11);
                }
            }
            if (sigma > 1)
                EXPECT_EQ(chance.mean(), 1);
            else
                EXPECT_LE(chance.mean(), 4e-3); // probability below 1e-6 each
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
    options.scale = Color(1e-6f);
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
    for (const GridMedium& medium : {make_medium(FloatGrid::create(0)),
                                     make_medium(make_grid(10, 1, V3d(0), [](int, int, int) { return 0.0; })), [] {
                                         GridMediumOptions none;
                                         none.scale = Color(0);
                                         return make_medium(make_grid(10, 1, V3d(0), [](int, int, int) { return 1.0; }),
                                                            none);
                                     }()}) {
        Sampler sampler(1, 0, 0, 0);
        SpectralState state;
        EXPECT_FALSE(medium.event({-5, 5, 5}, {1, 0, 0}, 0, infinity, state, sampler).scattered);
        EXPECT_EQ(medium.transmittance({-5, 5, 5}, {1, 0, 0}, 0, infinity, sampler), Color(1));
        EXPECT_EQ(medium.largest_sigma_t(), 0);
        EXPECT_TRUE(medium.is_achromatic());
    }
    EXPECT_TRUE(make_medium(FloatGrid::create(0)).bounds().isEmpty());
}

/// Walks end for rays with NaN or infinite values, or without direction.
TEST(GridMedium, RaysThatAreNone)
{
    const GridMedium medium = make_medium(make_grid(20, 0.1, V3d(0), [](int i, int, int) { return i % 2 + 0.5; }));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const V3d& bad : {V3d(nan, 0, 0), V3d(infinity, 1, 0), V3d(0, 0, 0)}) {
        Sampler sampler(1, 0, 0, 0);
        SpectralState state;
        EXPECT_FALSE(medium.event({1, 1, 1}, bad, 0, infinity, state, sampler).scattered);
        EXPECT_EQ(medium.transmittance({1, 1, 1}, bad, 0, infinity, sampler), Color(1));
    }
    Sampler sampler(1, 0, 0, 0);
    SpectralState state;
    EXPECT_FALSE(medium.event({1, 1, 1}, {1, 0, 0}, 2, 1, state, sampler).scattered);
    EXPECT_FALSE(medium.event({1, 1, 1}, {1, 0, 0}, 5, infinity, state, sampler).scattered);
}

TEST(GridMedium, WalksAreTheSameWhateverTheyStartFrom)
{
    // A ray cut in two has the same transmittance; so has a ray whose origin is far back on the same line.
    const GridMedium medium = make_medium(
        make_grid(edge, 0.05, V3d(-1), [](int i, int j, int k) { return ((i / 4 + j / 3 + k / 5) % 3) * 0.5; }));
    const V3d d = V3d(1, 0.6, 0.4).normalized(), o(-0.9, -0.5, -0.5);
    const double depth = optical_depth(medium, {o, d}, 0.3, 1.4, 200000);
    expect_depth(medium, {o, d, 0.3, 1.4}, depth, 40000);
    expect_depth(medium, {o - d * 1e5, d, 1e5 + 0.3, 1e5 + 1.4}, depth, 40000);
}

} // namespace
} // namespace scree
