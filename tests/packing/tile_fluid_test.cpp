#include "packing/report/hard_sphere_fluid.h"
#include "packing/report/packed_spheres.h"
#include "packing/report/pair_correlation.h"
#include "packing/tiles/tile_generator.h"
#include "packing/tiles/tile_sizes.h"
#include "tests/builders/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

MadeTile fluid(uint64_t count, double fraction, uint32_t variants, uint64_t seed, std::optional<uint64_t> sweeps = {},
               const std::vector<std::string>& sizes = {"mono"})
{
    TileOptions options;
    options.fraction = fraction;
    options.variants = variants;
    options.seed = seed;
    options.sweeps = sweeps;
    return make_tile(draw_tile_radii(parse_tile_sizes(sizes), count, seed), options, {});
}

/// Pairs of a variant whose distance is below x times the sum of their radii.
uint64_t pairs_within(const PackingTile& tile, size_t variant, double x)
{
    const auto& place = tile.variants[variant];
    uint64_t pairs = 0;
    for (uint64_t i = 0; i < tile.rows(); ++i)
        for (uint64_t j = i + 1; j < tile.rows(); ++j) {
            Imath::V3d d = place[j] - place[i];
            for (int axis = 0; axis < 3; ++axis) d[axis] -= std::round(d[axis]);
            const double reach = x * (static_cast<double>(tile.radius[i]) + static_cast<double>(tile.radius[j]));
            pairs += d.length2() < reach * reach;
        }
    return pairs;
}

/// The number of pairs within 1.05 diameters over that of the theory: Carnahan-Starling at contact, with the slope of
/// Percus-Yevick. first, last: the variants that are counted.
Estimate near_contact(double f, uint64_t count, int tiles, size_t first, size_t last)
{
    constexpr int steps = 1000;
    const std::vector<double> py = percus_yevick(f, steps, 1.06);
    double expected = 0;
    for (int k = 0; k < 50; ++k) {
        const double x = 1 + (k + 0.5) / steps, g = carnahan_starling_contact(f) *
                                                    (py[static_cast<size_t>(k)] + py[static_cast<size_t>(k) + 1]) /
                                                    (2 * py[0]);
        expected += 12 * f * static_cast<double>(count) * x * x * g / steps;
    }
    Estimate ratio;
    for (int seed = 0; seed < tiles; ++seed) {
        const PackingTile tile = fluid(count, f, static_cast<uint32_t>(last + 1), static_cast<uint64_t>(seed)).tile;
        for (size_t v = first; v <= last; ++v) ratio.add(static_cast<double>(pairs_within(tile, v, 1.05)) / expected);
    }
    return ratio;
}

// Carnahan-Starling is within 0.3 % of the exact fluid, and over 0.05 diameters the slope of Percus-Yevick costs no
// more.
constexpr double theory_error = 0.006;

TEST(TileFluid, EqualSpheresHaveTheContactValueOfCarnahanAndStarling)
{
    for (const auto& [f, count] : {std::pair<double, uint64_t>{0.1, 2000}, {0.3, 1000}, {0.4, 500}}) {
        const Estimate ratio = near_contact(f, count, 12, 0, 0);
        EXPECT_LT(ratio.standard_error(), 0.03) << f;
        EXPECT_LT(std::abs(ratio.mean() - 1), 4 * ratio.standard_error() + theory_error)
            << f << ": " << ratio.mean() << " +- " << ratio.standard_error();
    }
}

// Later variants sample the fluid as well as the first one: they are in equilibrium given the boundary.
TEST(TileFluid, VariantsHaveItToo)
{
    const Estimate ratio = near_contact(0.3, 1000, 6, 1, 3);
    EXPECT_LT(ratio.standard_error(), 0.03);
    EXPECT_LT(std::abs(ratio.mean() - 1), 4 * ratio.standard_error() + theory_error)
        << ratio.mean() << " +- " << ratio.standard_error();
}

// The contact value of the mixture's equation of state, from the pressure along free paths.
TEST(TileFluid, MixturesHaveThatOfTheirEquationOfState)
{
    Estimate ratio;
    for (uint64_t seed = 0; seed < 12; ++seed) {
        const MadeTile made = fluid(1000, 0.3, 1, seed, {}, {"bidisperse", "ratio=2"});
        const PackedSpheres packed(tile_frame(made.tile, 0), "tile");
        ratio.add(measure_pair_correlation(packed, 1000 / packed.volume()).free_path_contact.value /
                  bmcsl_contact(0.3, packed.moments()));
    }
    EXPECT_LT(ratio.standard_error(), 0.03);
    EXPECT_LT(std::abs(ratio.mean() - 1), 4 * ratio.standard_error() + theory_error)
        << ratio.mean() << " +- " << ratio.standard_error();
}

// Moving random places apart leaves spheres in contact that had overlapped. A fluid has no such excess: its g is 1.03
// at contact and falls linearly (virial expansion: g = 1 + f (8 - 6 x + x^3 / 2) for x < 2).
TEST(TileFluid, ADiluteTileHasNoPileAtContact)
{
    const double f = 0.01;
    const uint64_t count = 2000;
    Estimate ratio;
    for (uint64_t seed = 0; seed < 12; ++seed) {
        const PackingTile tile = fluid(count, f, 1, seed).tile;
        double expected = 0;
        for (double x = 1.0005; x < 1.5; x += 0.001)
            expected += 12 * f * static_cast<double>(count) * x * x * (1 + f * (8 - 6 * x + x * x * x / 2)) * 0.001;
        ratio.add(static_cast<double>(pairs_within(tile, 0, 1.5)) / expected);
    }
    EXPECT_LT(ratio.standard_error(), 0.03);
    EXPECT_LT(std::abs(ratio.mean() - 1), 4 * ratio.standard_error())
        << ratio.mean() << " +- " << ratio.standard_error();
    uint64_t piled = 0, spread = 0;
    for (uint64_t seed = 0; seed < 12; ++seed) {
        piled += pairs_within(fluid(count, f, 1, seed, 0).tile, 0, 1.001);
        spread += pairs_within(fluid(count, f, 1, seed).tile, 0, 1.001);
    }
    // 12 fluid tiles hold 2.9 pairs within 1.001 diameters, with a standard deviation of 1.7; tiles without sweeps hold
    // far more.
    EXPECT_LT(static_cast<double>(spread), 2.9 + 4 * 1.7);
    EXPECT_GT(static_cast<double>(piled), 2.9 + 8 * 1.7);
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
