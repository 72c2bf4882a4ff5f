#include "packing/report/bond_order.h"
#include "packing/report/near_pairs.h"
#include "packing/report/packed_spheres.h"
#include "packing/tiles/tile_generator.h"
#include "packing/tiles/tile_relaxation.h"
#include "packing/tiles/tile_sizes.h"
#include "tests/builders/test_files.h"

#include <gmock/gmock.h>
#include <tbb/global_control.h>

#include <cmath>

namespace scree {
namespace {

using testing::HasSubstr;

MadeTile tile_of(const std::vector<std::string>& words, uint64_t count, std::optional<double> fraction,
                 uint32_t variants = 1, uint64_t seed = 1, const Imath::V3d& size = Imath::V3d(1))
{
    TileOptions options;
    options.size = size;
    options.fraction = fraction;
    options.variants = variants;
    options.seed = seed;
    return make_tile(draw_tile_radii(parse_tile_sizes(words), count, seed), options, {});
}

/// The largest (r_i + r_j - d) / min(r_i, r_j) over all pairs and all 125 images within two cuboids.
double brute_overlap(const PackingTile& tile, size_t variant)
{
    double worst = -1;
    const auto& place = tile.variants[variant];
    for (uint64_t i = 0; i < tile.rows(); ++i)
        for (uint64_t j = i; j < tile.rows(); ++j)
            for (int image = 0; image < 125; ++image) {
                const Imath::V3d shift(image % 5 - 2, image / 5 % 5 - 2, image / 25 - 2);
                if (i == j && shift == Imath::V3d(0)) continue;
                const double ri = tile.radius[i], rj = tile.radius[j];
                const double d = (place[j] + shift * tile.size - place[i]).length();
                worst = std::max(worst, (ri + rj - d) / std::min(ri, rj));
            }
    return worst;
}

TEST(TilePacking, NothingOverlapsByBruteForce)
{
    struct Case {
        std::vector<std::string> sizes;
        std::optional<double> fraction;
        Imath::V3d size;
    };
    for (const Case& c : {Case{{"mono"}, std::nullopt, {1, 1, 1}}, Case{{"bidisperse"}, 0.6, {1, 2, 0.7}},
                          Case{{"lognormal"}, 0.4, {3, 1, 1}}, Case{{"power", "ratio=5"}, std::nullopt, {1, 1, 1}},
                          Case{{"mono"}, 0.02, {1, 1, 4}}}) {
        const MadeTile made = tile_of(c.sizes, 200, c.fraction, 2, 7, c.size);
        for (size_t v = 0; v < 2; ++v) {
            const double brute = brute_overlap(made.tile, v);
            EXPECT_LE(brute, 0) << c.sizes[0];
            EXPECT_DOUBLE_EQ(largest_tile_overlap(made.tile, v).overlap, brute) << c.sizes[0];
            for (const Imath::V3d& p : made.tile.variants[v])
                for (int axis = 0; axis < 3; ++axis) {
                    EXPECT_GE(p[axis], 0);
                    EXPECT_LT(p[axis], c.size[axis]);
                }
        }
    }
}

TEST(TilePacking, OverlapsOfAnyKindAreFound)
{
    PackingTile tile;
    tile.size = {1, 1, 1};
    tile.radius = {0.2f, 0.1f, 0.01f};
    tile.variants = {{{0.1, 0.5, 0.5}, {0.85, 0.5, 0.5}, {0.5, 0.1, 0.1}}};
    TileOverlap worst = largest_tile_overlap(tile, 0); // 0.25 apart, through a face
    EXPECT_NEAR(worst.overlap, 0.05 / 0.1, 1e-6);
    EXPECT_EQ(worst.rows[0], 0u);
    EXPECT_EQ(worst.rows[1], 1u);
    tile.variants[0][2] = {0.1, 0.6, 0.5}; // inside another sphere
    worst = largest_tile_overlap(tile, 0);
    EXPECT_NEAR(worst.overlap, (0.21 - 0.1) / 0.01, 1e-4);
    EXPECT_EQ(worst.rows[1], 2u);
    tile.radius = {0.6f, 0.001f, 0.001f}; // overlaps its own image
    EXPECT_NEAR(largest_tile_overlap(tile, 0).overlap, 601 - std::sqrt(0.01) * 1000, 600);
}

TEST(TilePacking, TheFractionIsTheOneAskedFor)
{
    // Radii are floats, rounded down: a relative error of 2^-23 each.
    for (const double f : {0.01, 0.3, 0.55, 0.62})
        for (const auto& words : {std::vector<std::string>{"mono"}, {"power", "ratio=8"}})
            EXPECT_NEAR(tile_of(words, 400, f).tile.fraction() / f, 1, 3 * 0x1p-23) << f;
}

TEST(TilePacking, TheSameSeedTheSameTileOnAnyNumberOfThreads)
{
    for (const std::optional<double> fraction : {std::optional<double>(), std::optional<double>(0.3)}) {
        PackingTile tiles[2];
        for (int k = 0; k < 2; ++k) {
            const tbb::global_control threads(tbb::global_control::max_allowed_parallelism, k == 0 ? 1 : 2);
            tiles[k] = tile_of({"lognormal"}, 250, fraction, 2, 4).tile;
        }
        EXPECT_EQ(tiles[0].radius, tiles[1].radius);
        EXPECT_EQ(tiles[0].shared, tiles[1].shared);
        EXPECT_EQ(tiles[0].variants, tiles[1].variants);
        EXPECT_NE(tiles[0].variants, tile_of({"lognormal"}, 250, fraction, 2, 5).tile.variants);
    }
}

// All lengths are relative: the cuboid times a power of two gives the same tile times it.
TEST(TilePacking, ScaleDoesNotMatter)
{
    for (const std::optional<double> fraction : {std::optional<double>(), std::optional<double>(0.3)}) {
        const PackingTile one = tile_of({"bidisperse"}, 300, fraction, 2).tile;
        const PackingTile big = tile_of({"bidisperse"}, 300, fraction, 2, 1, Imath::V3d(0x1p40)).tile;
        ASSERT_EQ(one.rows(), big.rows());
        for (uint64_t row = 0; row < one.rows(); ++row) {
            EXPECT_FLOAT_EQ(big.radius[row], one.radius[row] * 0x1p40f);
            EXPECT_LT((big.variants[1][row] * 0x1p-40 - one.variants[1][row]).length(), 1e-9);
        }
    }
}

// Jammed packings of equal frictionless spheres: f is about 0.64, with 6 contacts per sphere without rattlers (O'Hern
// et al. 2003: phi_J = 0.639 for many spheres; up to 0.65 if compressed more slowly), and no crystal. Jammed means
// isostatic: Nc = 3 N' - 3, z = 6 - 6 / N'.
TEST(TilePacking, EqualSpheresJamAtRandomClosePacking)
{
    const MadeTile made = tile_of({"mono"}, 2000, std::nullopt);
    EXPECT_GT(made.tile.fraction(), 0.635);
    EXPECT_LT(made.tile.fraction(), 0.652);
    const PackedSpheres packed(tile_frame(made.tile, 0), "tile");
    const NearPairs pairs = measure_near_pairs(packed);
    // Gaps up to the tolerance of 1e-3 count as contacts; they are some 0.2 per sphere.
    EXPECT_NEAR(pairs.mean_contacts_without_rattlers, 6.1, 0.25);
    EXPECT_LT(pairs.rattlers, 0.06 * 2000);
    const BondOrder order = measure_bond_order(packed, 2000 / packed.volume());
    EXPECT_LT(order.crystal_fraction, 0.1);
    EXPECT_LT(order.global_q6, 0.1); // fcc has 0.575, so a crystal of a fifth of the spheres would show
}

TEST(TilePacking, MixturesReachWhatTheLiteratureGives)
{
    // O'Hern et al. 2003, figure 9 and text: 0.648 for 50:50 of ratio 1.4.
    EXPECT_GT(tile_of({"bidisperse"}, 2000, std::nullopt).tile.fraction(), 0.648);
    // Desmond and Weeks 2014, equation 7: 0.662 for the lognormal of sigma 0.3.
    EXPECT_GT(tile_of({"lognormal"}, 2000, std::nullopt).tile.fraction(), 0.662);
}

TEST(TilePacking, AWidePowerLaw)
{
    const MadeTile made = tile_of({"power", "exponent=3", "ratio=20"}, 1500, 0.6, 2);
    EXPECT_NEAR(made.tile.fraction(), 0.6, 1e-6);
    EXPECT_GT(made.tile.largest_radius() / *std::ranges::min_element(made.tile.radius), 10);
    for (size_t v = 0; v < 2; ++v) EXPECT_LE(largest_tile_overlap(made.tile, v).overlap, 0);
}

TEST(TilePacking, WhatCannotBeDoneIsSaid)
{
    const auto error = [](uint64_t count, std::optional<double> fraction, uint32_t variants = 1,
                          Imath::V3d size = Imath::V3d(1)) {
        return std::string(
            test::input_error_of([&] { tile_of({"mono"}, count, fraction, variants, 1, size); }).value().what());
    };
    EXPECT_THAT(error(300, 0.72), HasSubstr("at most 0.6"));
    EXPECT_THAT(error(300, 1.2), HasSubstr("above 0 and below 1"));
    EXPECT_THAT(error(300, 0.0), HasSubstr("above 0 and below 1"));
    EXPECT_THAT(error(300, std::nan("")), HasSubstr("above 0 and below 1"));
    EXPECT_THAT(error(1, 0.5), HasSubstr("more spheres"));
    EXPECT_THAT(error(300, 0.5, 0), HasSubstr("1 variant or more"));
    EXPECT_THAT(error(2, 0.2, 2), HasSubstr("none of which is wholly inside"));
    EXPECT_THAT(error(300, 0.5, 1, {1, 0, 1}), HasSubstr("edges above 0"));
    EXPECT_THAT(error(300, 0.5, 1, {1, 100, 1}), HasSubstr("more spheres"));
    EXPECT_THAT(std::string(test::input_error_of([] { make_tile({}, {}, {}); }).value().what()),
                HasSubstr("no spheres"));
}

TEST(TilePacking, CanBeCancelled)
{
    const Progress* handle = nullptr;
    Progress progress([&](const std::string&, double) { const_cast<Progress*>(handle)->cancel(); });
    handle = &progress;
    const std::vector<double> radii(2000, 1.0);
    EXPECT_THROW(make_tile(radii, {}, progress), Cancelled);
}

// Two soft spheres alone move apart along their line until they touch.
TEST(TileRelaxation, TwoSpheresPartAlongTheirLine)
{
    TileSpheres spheres;
    spheres.radius = {0.1, 0.1};
    spheres.place.assign(2, {0.98, 0.5, 0.5});
    spheres.place[1].x = 0.08;
    TileRelaxation soft(spheres);
    EXPECT_EQ(soft.relax(1, {.allowed = 1e-6}, {}), TileRelaxation::Outcome::separated);
    const std::vector<Imath::V3d> places = soft.places();
    double apart = places[1].x - places[0].x;
    apart -= std::floor(apart);
    EXPECT_GE(apart, 0.2 * (1 - 1e-6));
    EXPECT_LT(apart, 0.3);
    EXPECT_NEAR(places[0].y, 0.5, 1e-12);
    EXPECT_NEAR(places[0].x + places[1].x, 1.06, 1e-9); // momentum is conserved
}

// Compressed far beyond jamming, the forces balance and the overlap remains.
TEST(TileRelaxation, AFullCuboidBalances)
{
    TileSpheres spheres;
    spheres.radius.assign(8, 0.3); // with two spheres along an edge of 1, they overlap
    for (int i = 0; i < 8; ++i) spheres.place.push_back({0.01 + 0.5 * (i % 2), 0.5 * (i / 2 % 2), 0.5 * (i / 4)});
    TileRelaxation soft(spheres);
    EXPECT_EQ(soft.relax(1, {}, {}), TileRelaxation::Outcome::balanced);
    EXPECT_NEAR(soft.state().worst_overlap, 0.1 / 0.6, 1e-2);
}

} // namespace
} // namespace scree
