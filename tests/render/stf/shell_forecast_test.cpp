// The forecast, by walks, of whether shells save work in a grid medium.

#include "render/stf/shell_forecast.h"

#include "tests/builders/shapes.h"
#include "tests/render/media/medium_grids.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace scree {
namespace {

constexpr int n = 40;
constexpr size_t shells = 17; // up to 256 mean free paths

double smooth(int, int, int) { return 1; }

/// Five octaves of waves, from 0 up.
double fractal(int i, int j, int k)
{
    double sum = 0, scale = 0.1, weight = 0.5;
    for (int octave = 0; octave < 5; ++octave, scale *= 2, weight *= 0.7)
        sum +=
            weight * std::sin(scale * i + octave) * std::sin(scale * j + 2 * octave) * std::sin(scale * k + 3 * octave);
    return std::exp(4 * sum);
}

/// The forecast for a cube from -size to size. sigma_t: for size 1, where the density is 1.
ShellForecast forecast(const std::function<double(int, int, int)>& density, double sigma_t, double size = 1)
{
    const double h = 2 * size / (n - 1);
    GridMediumOptions options;
    options.scale = Color(static_cast<float>(sigma_t / size));
    options.albedo = Weight(0.9995);
    options.g = 0.8;
    const GridMedium medium = make_medium(make_grid(n, h, V3d(-size), density), options);
    const Imath::Box3d box(V3d(-size), V3d(size));
    const TriangleMesh mesh = box_mesh(box.min, box.max);
    std::vector<V3f> positions;
    for (const V3d& p : mesh.positions) positions.emplace_back(p);
    const std::vector<TriangleView> faces{{positions, mesh.triangles}};
    const ClearanceField clearance(faces, box, {});
    return forecast_shells(medium, MediumPyramid(medium, box, 0.05, 0.5, {}), box, clearance, shells, {});
}

void expect_same(const ShellForecast& a, const ShellForecast& b)
{
    EXPECT_EQ(a.scatterings, b.scatterings);
    EXPECT_EQ(a.queries, b.queries);
    EXPECT_EQ(a.shells, b.shells);
    EXPECT_EQ(a.skipped, b.skipped);
    EXPECT_EQ(a.lit, b.lit);
}

TEST(ShellForecast, KeepsShellsWhereAThickMediumIsSmooth)
{
    const ShellForecast found = forecast(smooth, 200);
    EXPECT_GT(found.part(), 0.6);
    EXPECT_GT(found.each(), 3);
    EXPECT_LT(found.work(true), 0.6);
    EXPECT_LT(found.work(false), 0.95) << "a scattering is cheap where no light is sampled";
    EXPECT_GT(found.work(false), found.work(true));
}

TEST(ShellForecast, LeavesThemOutWhereItIsThinOrFractal)
{
    EXPECT_GT(forecast(smooth, 5).work(true), 1);
    for (const double sigma_t : {20.0, 200.0}) {
        const ShellForecast found = forecast(fractal, sigma_t);
        EXPECT_GT(found.scatterings, 10'000u);
        EXPECT_LT(found.part(), 0.2) << sigma_t;
        EXPECT_GT(found.work(true), 1) << sigma_t;
    }
}

TEST(ShellForecast, IsTheSameAtAnyScaleAndNumberOfThreads)
{
    const ShellForecast once = forecast(fractal, 100), smoothly = forecast(smooth, 100);
    for (const double size : {0x1p-8, 0x1p12}) {
        expect_same(forecast(fractal, 100, size), once);
        expect_same(forecast(smooth, 100, size), smoothly);
    }
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    expect_same(forecast(fractal, 100), once);
}

TEST(ShellForecast, OfNothingIsNothing)
{
    const ShellForecast none;
    EXPECT_EQ(none.part(), 0);
    EXPECT_EQ(none.each(), 0);
    EXPECT_EQ(none.work(true), 1);
}

} // namespace
} // namespace scree
