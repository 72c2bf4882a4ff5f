#include "base/hash.h"
#include "packing/tiles/tile_generator.h"
#include "packing/tiles/tile_sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

MadeTile tile_of(const std::vector<std::string>& words, uint64_t count, std::optional<double> fraction,
                 uint32_t variants)
{
    TileOptions options;
    options.size = {1, 1.25, 0.9};
    options.fraction = fraction;
    options.variants = variants;
    options.seed = 3;
    return make_tile(draw_tile_radii(parse_tile_sizes(words), count, 3), options, {});
}

struct Named {
    const char* name;
    std::vector<std::string> sizes;
    std::optional<double> fraction;
};
class TileVariants : public testing::TestWithParam<Named> {};

INSTANTIATE_TEST_SUITE_P(Kinds, TileVariants,
                         testing::Values(Named{"fluid", {"mono"}, 0.2}, Named{"parted", {"bidisperse"}, 0.58},
                                         Named{"jammed", {"mono"}, std::nullopt},
                                         Named{"wide", {"power", "ratio=6"}, 0.55}),
                         [](const auto& one) { return one.param.name; });

// 2 x 2 x 2 cells with a variant each, repeated around them: tests all pairs of spheres of the block.
TEST_P(TileVariants, AnyVariantFitsBesideAnyOther)
{
    const PackingTile tile = tile_of(GetParam().sizes, 250, GetParam().fraction, 3).tile;
    ASSERT_EQ(tile.variants.size(), 3u);
    for (uint64_t trial = 0; trial < 3; ++trial) {
        std::vector<Imath::V3d> place;
        std::vector<double> radius;
        for (uint64_t cell = 0; cell < 8; ++cell) {
            const auto& inside = tile.variants[hash_index(cell, trial) % 3];
            const Imath::V3d corner =
                tile.size * Imath::V3d(static_cast<double>(cell % 2), static_cast<double>(cell / 2 % 2),
                                       static_cast<double>(cell / 4));
            for (uint64_t row = 0; row < tile.rows(); ++row) {
                place.push_back(corner + inside[row]);
                radius.push_back(tile.radius[row]);
            }
        }
        double worst = -1;
        for (size_t i = 0; i < place.size(); ++i)
            for (size_t j = i + 1; j < place.size(); ++j) {
                Imath::V3d d = place[j] - place[i];
                for (int axis = 0; axis < 3; ++axis)
                    d[axis] -= std::round(d[axis] / (2 * tile.size[axis])) * 2 * tile.size[axis];
                worst = std::max(worst, (radius[i] + radius[j] - d.length()) / std::min(radius[i], radius[j]));
            }
        EXPECT_LE(worst, 0);
    }
}

TEST_P(TileVariants, SharedRowsAreAllThatReachThroughFaces)
{
    const PackingTile tile = tile_of(GetParam().sizes, 250, GetParam().fraction, 3).tile;
    EXPECT_GT(tile.shared, 0u);
    EXPECT_LT(tile.shared, tile.rows());
    for (size_t v = 0; v < 3; ++v)
        for (uint64_t row = 0; row < tile.rows(); ++row) {
            const Imath::V3d& p = tile.variants[v][row];
            if (row < tile.shared)
                EXPECT_EQ(p, tile.variants[0][row]);
            else
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_GE(std::min(p[axis], tile.size[axis] - p[axis]), tile.radius[row]);
        }
}

/// The share of centres of variant a, at least `shallow` from the faces, that have a centre of variant b within 0.2
/// radii. For independent packings of equal spheres it is 0.008 f: the number density times the volume of the ball.
double coincidences(const PackingTile& tile, size_t a, size_t b, double shallow)
{
    const auto &first = tile.variants[a], &second = tile.variants[b];
    uint64_t deep = 0, near = 0;
    for (uint64_t row = tile.shared; row < tile.rows(); ++row) {
        const Imath::V3d &p = first[row], to_far = tile.size - p;
        if (std::min({p.x, p.y, p.z, to_far.x, to_far.y, to_far.z}) < shallow) continue;
        ++deep;
        for (uint64_t other = tile.shared; other < tile.rows(); ++other)
            near += (p - second[other]).length() < 0.2 * tile.radius[row];
    }
    EXPECT_GT(deep, 100u);
    return static_cast<double>(near) / static_cast<double>(deep);
}

TEST_P(TileVariants, InsidesDiffer)
{
    if (!GetParam().fraction) return; // jammed tiles must be larger: see TileVariantsOfJammed
    const PackingTile tile = tile_of(GetParam().sizes, 600, GetParam().fraction, 3).tile;
    for (const auto& [a, b] : {std::pair<size_t, size_t>{0, 1}, {0, 2}, {1, 2}}) {
        EXPECT_LT(coincidences(tile, a, b, 0), 0.1);
        double mean = 0;
        for (uint64_t row = tile.shared; row < tile.rows(); ++row)
            mean += (tile.variants[a][row] - tile.variants[b][row]).length() /
                    static_cast<double>(tile.rows() - tile.shared);
        // Independent uniform places in a cuboid of about unit edges are 0.66 apart on average.
        EXPECT_GT(mean, 4 * tile.mean_radius());
    }
}

// Within two diameters of the faces, the boundary decides where jammed spheres lie, in every variant; deeper spheres
// differ.
TEST(TileVariantsOfJammed, DifferDeepInside)
{
    const PackingTile tile = tile_of({"mono"}, 1800, std::nullopt, 2).tile;
    EXPECT_LT(coincidences(tile, 0, 1, 4 * tile.largest_radius()), 0.1);
}

TEST(TileVariantsOfJammed, AreJammedAtTheirCommonRadii)
{
    const MadeTile made = tile_of({"mono"}, 1000, std::nullopt, 2);
    EXPECT_LE(made.tile.fraction(), made.jammed_fraction);
    EXPECT_GT(made.tile.fraction(), 0.61);
    for (size_t v = 0; v < 2; ++v) {
        const TileOverlap gap = largest_tile_overlap(made.tile, v);
        EXPECT_LE(gap.overlap, 0);
        EXPECT_GT(gap.overlap, -1e-4);
    }
}

} // namespace
} // namespace scree
