// Means over cubes, from which shells take their medium.

#include "base/sampler.h"
#include "render/media/medium_pyramid.h"
#include "tests/render/media/medium_grids.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

/// A homogeneous medium has the right means in balls of every size.
TEST(MediumPyramid, KeepsWhatLittleIsLost)
{
    constexpr int n = 200; // more voxels than cubes in the first level
    const auto grid = make_grid(n, 2.0 / (n - 1), V3d(-1), [](int, int, int) { return 0.7; });
    for (const double loss : {1e-3, 1e-6, 1e-9}) {
        GridMediumOptions options;
        options.albedo = Weight(1 - loss, 1 - 2 * loss, 1 - 3 * loss);
        options.g = 0.3;
        const GridMedium medium = make_medium(grid, options);
        const MediumPyramid pyramid(medium, {V3d(-0.99), V3d(0.99)}, 0.05, 0.5, {});
        for (double radius = 0.9; radius > 0.001; radius /= 2) {
            MediumMean mean;
            ASSERT_TRUE(pyramid.is_same(V3d(0.05, -0.01, 0.02), radius, mean)) << radius;
            EXPECT_NEAR(mean.sigma_t, double{0.7f}, 1e-5);
            EXPECT_NEAR(mean.g, 0.3, 1e-5);
            for (unsigned c = 0; c < 3; ++c) EXPECT_NEAR((1 - mean.albedo[c]) / loss, c + 1, 1e-4) << radius;
        }
    }
}

/// halve_until_same() skips only balls that cannot be homogeneous, whatever the medium: its result is that of testing
/// each ball in turn.
TEST(MediumPyramid, FindsWhatEachBallInTurnWould)
{
    constexpr int n = 48;
    const auto noise = [](int i, int j, int k) {
        return static_cast<double>(Sampler::philox(
                   {static_cast<uint32_t>(i), static_cast<uint32_t>(j), static_cast<uint32_t>(k), 0}, {1, 2})[0]) *
               0x1p-32;
    };
    const std::vector<std::pair<const char*, std::function<double(int, int, int)>>> media{
        {"a ramp", [](int i, int, int) { return 1 + 0.02 * i; }},
        {"a face within", [](int i, int j, int) { return i + j < n ? 1.0 : 0.3; }},
        {"an edge that is soft", [](int i, int, int) { return std::clamp(0.1 * (i - 8), 0.0, 1.0); }},
        {"waves",
         [](int i, int j, int k) { return 1 + 0.5 * std::sin(0.3 * i) * std::sin(0.2 * j) * std::sin(0.1 * k); }},
        {"a board", [](int i, int j, int k) { return (i / 8 + j / 8 + k / 8) % 2 ? 1.9 : 0.1; }},
        {"noise", [noise](int i, int j, int k) { return 1 + 0.5 * noise(i, j, k); }},
        {"little noise", [noise](int i, int j, int k) { return 1 + 0.05 * noise(i, j, k); }},
    };
    for (const auto& [name, density] : media) {
        const auto grid = make_grid(n, 2.0 / (n - 1), V3d(-1), density);
        uint32_t found = 0, none = 0;
        for (const float scale : {5.f, 50.f, 1000.f}) {
            GridMediumOptions options;
            options.scale = Color(scale);
            const GridMedium medium = make_medium(grid, options);
            const MediumPyramid pyramid(medium, {V3d(-0.99), V3d(0.99)}, 0.05, 0.5, {});
            Sampler sampler(3, 0, 0, 0);
            for (int i = 0; i < 4000; ++i) {
                const V3d place(1.9 * (sampler.next() - 0.5), 1.9 * (sampler.next() - 0.5),
                                1.9 * (sampler.next() - 0.5));
                double clear = 0.99;
                for (int k = 0; k < 3; ++k) clear = std::min(clear, 0.99 - std::abs(place[k]));
                clear *= std::max(0.01, sampler.next());
                MediumMean expected, mean;
                double truth = clear, radius = clear;
                bool fits = false;
                while (truth * pyramid.extremes().sigma_t_high >= 1 && !fits) {
                    fits = pyramid.is_same(place, truth, expected) && truth * expected.sigma_t >= 1;
                    if (!fits) truth /= 2;
                }
                const bool is_found = pyramid.halve_until_same(place, radius, mean);
                if (is_found && radius * mean.sigma_t < 1) continue; // smaller balls are not searched
                ASSERT_EQ(is_found, fits) << name << ", scale " << scale << ", " << clear << " around " << place;
                ++(fits ? found : none);
                if (!fits) continue;
                ASSERT_EQ(radius, truth) << name;
                ASSERT_EQ(mean.sigma_t, expected.sigma_t) << name;
            }
        }
        std::printf("%-20s %5u found, %5u not\n", name, found, none);
        EXPECT_GT(found, 0u) << name;
        EXPECT_GT(none, 0u) << name;
    }
}

} // namespace
} // namespace scree
