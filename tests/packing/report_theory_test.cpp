#include "packing/report/hard_sphere_fluid.h"
#include "packing/report/near_pairs.h"
#include "packing/report/solid_fraction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace scree {
namespace {

RadiusMoments moments_of(const std::vector<double>& radii)
{
    RadiusMoments m;
    for (int k = 1; k <= 6; ++k)
        for (const double r : radii) m.m[k] += std::pow(r, k) / double(radii.size());
    return m;
}

TEST(ReportTheory, CarnahanStarling)
{
    EXPECT_NEAR(carnahan_starling_contact(0.3), 0.85 / 0.343, 1e-12);
    // Z = 1 + 4 f g(1) = (1 + f + f^2 - f^3) / (1 - f)^3
    for (const double f : {0.05, 0.2, 0.45})
        EXPECT_NEAR(1 + 4 * f * carnahan_starling_contact(f), (1 + f + f * f - f * f * f) / std::pow(1 - f, 3), 1e-12);
}

TEST(ReportTheory, MixturesOfOneSizeAreCarnahanStarling)
{
    for (const double f : {0.1, 0.3, 0.49})
        EXPECT_NEAR(bmcsl_contact(f, moments_of({0.7})), carnahan_starling_contact(f), 1e-12);
}

TEST(ReportTheory, MixtureAveragedPairByPair)
{
    const std::vector<double> radii{0.2, 0.5, 0.5, 1.3};
    const RadiusMoments m = moments_of(radii);
    const double f = 0.37, xi2 = f * (4 * m.m[2]) / (8 * m.m[3]), e = 1 - f;
    double sum = 0, weight = 0;
    for (const double a : radii)
        for (const double b : radii) {
            const double d = 2 * a * 2 * b / (2 * a + 2 * b), w = std::pow(a + b, 3);
            sum += w * (1 / e + 3 * xi2 * d / (e * e) + 2 * xi2 * xi2 * d * d / (e * e * e));
            weight += w;
        }
    EXPECT_NEAR(bmcsl_contact(f, m), sum / weight, 1e-12);
}

TEST(ReportTheory, PercusYevickAtContact)
{
    for (const double f : {0.05, 0.3, 0.49})
        EXPECT_NEAR(percus_yevick(f, 100, 2)[0], (1 + f / 2) / ((1 - f) * (1 - f)), 1e-12);
}

TEST(ReportTheory, PercusYevickConverges)
{
    // The trapezoid rule: steps a quarter as long give a sixteenth of the error.
    for (const double x : {1.5, 2.0, 3.25}) {
        const auto at = [&](int steps) {
            return percus_yevick(0.4, steps, 4)[static_cast<size_t>(std::lround((x - 1) * steps))];
        };
        const double best = at(1024), coarse = at(64) - best, fine = at(256) - best;
        EXPECT_LT(std::abs(fine), std::abs(coarse) / 10) << x;
        EXPECT_LT(std::abs(coarse), 2e-3) << x;
    }
}

TEST(ReportTheory, PercusYevickKeepsItsSumRule)
{
    // Compressibility: 1 + 24 f int (g - 1) x^2 dx = (1 - f)^4 / (1 + 2 f)^2; the hole gives -8 f.
    const double f = 0.25;
    const int steps = 200;
    const std::vector<double> g = percus_yevick(f, steps, 12);
    double sum = 0;
    for (size_t k = 0; k < g.size(); ++k) {
        const double x = 1 + double(k) / steps;
        sum += (k == 0 || k + 1 == g.size() ? 0.5 : 1) * (g[k] - 1) * x * x / steps;
    }
    EXPECT_NEAR(1 - 8 * f + 24 * f * sum, std::pow(1 - f, 4) / std::pow(1 + 2 * f, 2), 1e-4);
}

TEST(ReportTheory, PercusYevickLowDensity)
{
    // g = 1 + f g_1 with g_1(x) = 8 - 6 x + x^3 / 2 for 1 < x < 2, exactly (overlap of two exclusion spheres).
    const double f = 1e-4;
    const auto g = percus_yevick(f, 500, 3);
    for (const double x : {1.0, 1.25, 1.5, 1.9})
        EXPECT_NEAR((g[static_cast<size_t>(std::lround((x - 1) * 500))] - 1) / f, 8 - 6 * x + x * x * x / 2, 3e-3) << x;
    EXPECT_NEAR((g[750] - 1) / f, 0, 3e-3);
}

TEST(ReportTheory, MeanChord) { EXPECT_NEAR(mean_void_chord(0.3, moments_of({2})), 4 * 0.7 * 2 / 0.9, 1e-12); }

TEST(ReportTheory, BallInBox)
{
    const double whole = 4.0 / 3 * std::numbers::pi, far = std::numeric_limits<double>::infinity();
    const Imath::V3d open(far);
    EXPECT_DOUBLE_EQ(ball_in_box(Imath::V3d(0), 1, {-open, open}), whole);
    EXPECT_DOUBLE_EQ(ball_in_box(Imath::V3d(3, 0, 0), 1, {Imath::V3d(-1), Imath::V3d(1)}), 0);
    EXPECT_NEAR(ball_in_box(Imath::V3d(0), 1, {Imath::V3d(0), open}), whole / 8, 1e-3 * whole);
    EXPECT_NEAR(ball_in_box(Imath::V3d(0), 1, {Imath::V3d(0, -far, -far), open}), whole / 2, 1e-3 * whole);
    // A cap of height h: pi h^2 (1 - h / 3).
    const double h = 0.4;
    for (int axis = 0; axis < 3; ++axis) {
        Imath::Box3d box(-open, open);
        box.max[axis] = -1 + h;
        EXPECT_NEAR(ball_in_box(Imath::V3d(0), 1, box), std::numbers::pi * h * h * (1 - h / 3), 1e-3 * whole) << axis;
    }
    EXPECT_NEAR(ball_in_box(Imath::V3d(0), 1, {Imath::V3d(-0.1), Imath::V3d(0.1)}), 0.008, 1e-12);
}

TEST(ReportTheory, FabricOfKnownDirections)
{
    const FabricTensor line = fabric_of({10, 0, 0, 0, 0, 0}, 10);
    EXPECT_NEAR(line.deviatoric, 1, 1e-12);
    EXPECT_NEAR(line.eigenvalues[0], 1, 1e-12);
    EXPECT_NEAR(line.eigenvalues[2], 0, 1e-12);
    // Half of the directions along (1, 1, 0) / sqrt(2), half along z.
    const FabricTensor two = fabric_of({1, 1, 2, 1, 0, 0}, 4);
    EXPECT_NEAR(two.eigenvalues[0], 0.5, 1e-12);
    EXPECT_NEAR(two.eigenvalues[1], 0.5, 1e-12);
    EXPECT_NEAR(two.eigenvalues[2], 0, 1e-12);
    EXPECT_NEAR(two.deviatoric, 0.5, 1e-12);
}

} // namespace
} // namespace scree
