// Means over cubes, of which shells take the albedo.

#include "render/medium/medium_pyramid.h"
#include "tests/render/medium_grids.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

/// What a medium that is the same all over is in the mean, in balls of every size.
TEST(MediumPyramid, KeepsWhatLittleIsLost)
{
    constexpr int n = 200; // more voxels than the first level has cubes
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

} // namespace
} // namespace scree
