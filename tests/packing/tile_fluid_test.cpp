#include "packing/report/hard_sphere_fluid.h"
#include "packing/report/packed_spheres.h"
#include "packing/report/pair_correlation.h"
#include "packing/tile_generator.h"
#include "packing/tile_sizes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

MadeTile fluid(uint64_t count, double fraction, uint32_t variants, uint64_t seed, std::optional<uint64_t> sweeps = {}, const std::vector<std::string>& sizes = {"mono"})
{
    TileOptions options;
    options.fraction = fraction;
    options.variants = variants;
    options.seed = seed;
    options.sweeps = sweeps;
    return make_tile(draw_tile_radii(parse_tile_sizes(sizes), count, seed), options, {});
}

/// g at contact by free paths, over independent tiles; the standard error is that between them.
Estimate contact(double fraction, uint64_t count, int tiles, size_t variant, const std::vector<std::string>& sizes = {"mono"}, RadiusMoments* moments = nullptr)
{
    Estimate g;
    for (int seed = 0; seed < tiles; ++seed) {
        const MadeTile made = fluid(count, fraction, static_cast<uint32_t>(variant + 1), static_cast<uint64_t>(seed), {}, sizes);
        const PackedSpheres packed(tile_frame(made.tile, variant), "tile");
        if (moments) *moments = packed.moments();
        g.add(measure_pair_correlation(packed, static_cast<double>(count) / packed.volume()).free_path_contact.value);
    }
    return g;
}

// Carnahan-Starling is within 0.3 % of the exact fluid up to freezing.
TEST(TileFluid, EqualSpheresHaveTheContactValueOfCarnahanAndStarling)
{
    for (const double f : {0.1, 0.3, 0.45}) {
        const Estimate g = contact(f, 1000, 8, 0);
        const double theory = carnahan_starling_contact(f);
        EXPECT_LT(g.standard_error(), 0.01 * theory) << f;
        EXPECT_LT(std::abs(g.mean() - theory), 4 * g.standard_error() + 0.003 * theory) << f << ": " << g.mean() << " +- " << g.standard_error() << " against " << theory;
    }
}

// A later variant is a sample of the fluid as good as the first: given the boundary, in equilibrium.
TEST(TileFluid, VariantsHaveItToo)
{
    const Estimate g = contact(0.3, 1000, 8, 1);
    const double theory = carnahan_starling_contact(0.3);
    EXPECT_LT(std::abs(g.mean() - theory), 4 * g.standard_error() + 0.003 * theory) << g.mean() << " +- " << g.standard_error() << " against " << theory;
}

TEST(TileFluid, MixturesHaveThatOfTheirEquationOfState)
{
    RadiusMoments moments;
    const Estimate g = contact(0.3, 1000, 8, 0, {"bidisperse", "ratio=2"}, &moments);
    const double theory = bmcsl_contact(0.3, moments);
    EXPECT_LT(std::abs(g.mean() - theory), 4 * g.standard_error() + 0.005 * theory) << g.mean() << " +- " << g.standard_error() << " against " << theory;
}

/// Pairs of the tile whose distance is below x diameters.
uint64_t pairs_within(const PackingTile& tile, double x)
{
    const auto& place = tile.variants[0];
    uint64_t pairs = 0;
    for (uint64_t i = 0; i < tile.rows(); ++i)
        for (uint64_t j = i + 1; j < tile.rows(); ++j) {
            Imath::V3d d = place[j] - place[i];
            for (int axis = 0; axis < 3; ++axis) d[axis] -= std::round(d[axis]);
            pairs += d.length() < x * (static_cast<double>(tile.radius[i]) + static_cast<double>(tile.radius[j]));
        }
    return pairs;
}

// Parting random places leaves spheres in touch that had overlapped: at f = 0.01 some 7 % of all pairs within 1.2 diameters. A fluid has none of that pile:
// g is 1.03 at contact and falls linearly (virial expansion: g = 1 + f (8 - 6 x + x^3 / 2) for x < 2).
TEST(TileFluid, ADiluteTileHasNoPileAtContact)
{
    const double f = 0.01;
    const uint64_t count = 2000;
    Estimate ratio;
    for (uint64_t seed = 0; seed < 12; ++seed) {
        const PackingTile tile = fluid(count, f, 1, seed).tile;
        double expected = 0;
        for (double x = 1.0005; x < 1.5; x += 0.001) expected += 12 * f * static_cast<double>(count) * x * x * (1 + f * (8 - 6 * x + x * x * x / 2)) * 0.001;
        ratio.add(static_cast<double>(pairs_within(tile, 1.5)) / expected);
    }
    EXPECT_LT(ratio.standard_error(), 0.03);
    EXPECT_LT(std::abs(ratio.mean() - 1), 4 * ratio.standard_error()) << ratio.mean() << " +- " << ratio.standard_error();
    uint64_t piled = 0, spread = 0;
    for (uint64_t seed = 0; seed < 12; ++seed) {
        piled += pairs_within(fluid(count, f, 1, seed, 0).tile, 1.001);
        spread += pairs_within(fluid(count, f, 1, seed).tile, 1.001);
    }
    // 12 tiles hold 2.9 pairs within 1.001 in a fluid; without sweeps hundreds.
    EXPECT_LT(spread, 15u);
    EXPECT_GT(piled, 100u);
}

TEST(TileFluid, ItSaysWhatItDid)
{
    const MadeTile made = fluid(500, 0.2, 1, 1);
    EXPECT_TRUE(made.fluid);
    EXPECT_GE(made.fluid_run.sweeps, 200u);
    EXPECT_GE(made.fluid_run.displacement, 2 * std::cbrt(1.0 / 500));
    EXPECT_EQ(fluid(500, 0.2, 1, 1, 17).fluid_run.sweeps, 17u);
    EXPECT_FALSE(fluid(500, 0.6, 1, 1).fluid);
}

} // namespace
} // namespace scree
