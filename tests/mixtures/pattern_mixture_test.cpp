#include "base/hash.h"
#include "mixtures/blend_mixture.h"
#include "mixtures/checkerboard_mixture.h"
#include "mixtures/explicit_mixture.h"
#include "mixtures/single_mixture.h"
#include "tests/builders/statistics.h"
#include "tests/builders/test_files.h"
#include "tests/mixtures/mixture_builders.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scree {
namespace {

using Imath::V3d;
using Imath::V3f;

uint32_t type_at(const Mixture& mixture, const V3f& place, uint64_t index = 0) { return mixture.type(index, place); }

TEST(PossibleTypes, AreThoseThatAMixtureCanGive)
{
    const auto possible = [](const std::string& json) { return test::mixture_of(json, nullptr)->possible_types(); };
    using Types = std::set<uint32_t>;
    EXPECT_EQ(possible(R"({"kind": "checkerboard", "types": ["a", "c"], "cell": 2})"), (Types{0, 2}));
    EXPECT_EQ(possible(R"({"kind": "perlin", "types": ["b", "c"], "scale": 1})"), (Types{1, 2}));
    EXPECT_EQ(possible(R"({"kind": "random", "types": ["a", "b", "c"], "weights": [1, 0, 1]})"), (Types{0, 2}))
        << "no sphere draws a type of weight 0";
    EXPECT_EQ(possible(R"("b")"), Types{1});
    EXPECT_EQ(ExplicitMixture(std::vector<uint32_t>{7, 300, 7}).possible_types(), (Types{7, 300}));
    EXPECT_EQ(ExplicitMixture(std::vector<uint8_t>{2, 0, 2}).possible_types(), (Types{0, 2}));
    std::vector<std::unique_ptr<Mixture>> inner;
    inner.push_back(std::make_unique<SingleMixture>(4));
    inner.push_back(std::make_unique<SingleMixture>(5));
    EXPECT_EQ(BlendMixture(std::make_unique<SingleMixture>(1), std::move(inner)).possible_types(), Types{5})
        << "the other mixture is never chosen";
}

TEST(Checkerboard, CellsTakeTurns)
{
    const auto mixture = test::mixture_of(R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 2})", nullptr);
    EXPECT_EQ(type_at(*mixture, {0.1f, 0.1f, 0.1f}), 0u);
    EXPECT_EQ(type_at(*mixture, {1.9f, 1.9f, 1.9f}), 0u);
    EXPECT_EQ(type_at(*mixture, {2.1f, 0.1f, 0.1f}), 1u);
    EXPECT_EQ(type_at(*mixture, {-0.1f, 0.1f, 0.1f}), 1u);
    EXPECT_EQ(type_at(*mixture, {-0.1f, -0.1f, -0.1f}), 1u);
    EXPECT_EQ(type_at(*mixture, {2.1f, 2.1f, 0.1f}), 0u);
}

TEST(Checkerboard, ThreeTypesOffsetAndUnequalCells)
{
    const auto mixture = test::mixture_of(
        R"({"kind": "checkerboard", "types": ["a", "b", "c"], "cell": [1, 2, 4], "offset": [0.5, 0, 0]})", nullptr);
    for (int i = -4; i < 4; ++i)
        for (int j = -4; j < 4; ++j)
            for (int k = -4; k < 4; ++k) {
                const V3f middle(static_cast<float>(i) + 1.0f, static_cast<float>(2 * j + 1),
                                 static_cast<float>(4 * k + 2));
                EXPECT_EQ(type_at(*mixture, middle), static_cast<uint32_t>(((i + j + k) % 3 + 3) % 3));
            }
}

TEST(Checkerboard, RotationTurnsTheBoardAboutItsCorner)
{
    const auto turned = test::mixture_of(
        R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 1, "rotation": [0, 0, 45]})", nullptr);
    const float d = static_cast<float>(std::sqrt(0.5));
    EXPECT_EQ(type_at(*turned, {0, d, 0.5f}), 0u); // along the board's diagonal
    EXPECT_EQ(type_at(*turned, {d, 0, 0.5f}), 1u);
    const Imath::M33d m = rotation_in_degrees({20, -35, 70});
    EXPECT_NEAR((m * m.transposed())[0][1], 0, 1e-15);
    EXPECT_NEAR(m.determinant(), 1, 1e-15);
    EXPECT_EQ(V3d(1, 0, 0) * rotation_in_degrees({0, 0, 90}), V3d(0, 1, 0)); // exactly
    EXPECT_EQ(V3d(0, 1, 0) * rotation_in_degrees({-270, 0, 0}), V3d(0, 0, 1));
    const V3d p = V3d(1, 2, 3) * rotation_in_degrees({30, 0, 0});
    EXPECT_NEAR(p.y, 2 * std::sqrt(0.75) - 1.5, 1e-15);
    for (double angle = -720; angle < 720; angle += 7.3)
        // The angle in radians is rounded.
        EXPECT_NEAR(rotation_in_degrees({angle, 0, 0})[1][2], std::sin(angle * std::numbers::pi / 180), 4e-15);
}

TEST(Checkerboard, PlacesFarOutDoNotCrash)
{
    EXPECT_EQ(cell_of(-0.5), -1);
    EXPECT_EQ(cell_of(1e30), 0);
    EXPECT_EQ(cell_of(std::nan("")), 0);
    const auto mixture =
        test::mixture_of(R"({"kind": "checkerboard", "types": ["a", "b", "c"], "cell": 1e-300})", nullptr);
    EXPECT_LT(type_at(*mixture, {1e30f, -1e30f, 3}), 3u);
}

TEST(Patterns, DoNotDependOnTheFramesOrigin)
{
    // The same spheres with another origin: the pattern keeps its position in the file's coordinates.
    ParticleFrame frame = test::random_spheres(2000, 64, 0, V3d(1e6, -1e6, 0)), shifted = frame;
    shifted.origin += V3d(8, -16, 32);
    for (const char* json : {R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 5})",
                             R"({"kind": "perlin", "types": ["a", "b"], "scale": 5})",
                             R"({"kind": "layers", "types": ["a", "b"], "thicknesses": [1, 2]})"}) {
        const auto first = test::types_of(*test::mixture_of(json, &frame), frame);
        const auto second = test::types_of(*test::mixture_of(json, &shifted), shifted);
        int different = 0; // positions are rounded to float
        for (size_t i = 0; i < first.size(); ++i) different += first[i] != second[i];
        EXPECT_LE(different, 2) << json;
        EXPECT_NE(first, std::vector<uint32_t>(frame.size(), first[0]));
    }
}

TEST(Patterns, ScaleBySixteenWithTheScene)
{
    ParticleFrame frame = test::random_spheres(3000, 20), large = frame;
    for (V3d& p : large.position) p *= 16;
    const std::vector<std::pair<const char*, const char*>> pairs{
        {R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 3, "rotation": [10, 20, 30]})",
         R"({"kind": "checkerboard", "types": ["a", "b"], "cell": 48, "rotation": [10, 20, 30]})"},
        {R"({"kind": "perlin", "types": ["a", "b"], "scale": 3, "octaves": 3})",
         R"({"kind": "perlin", "types": ["a", "b"], "scale": 48, "octaves": 3})"},
        {R"({"kind": "layers", "types": ["a", "b"], "thicknesses": [1, 2], "jitter": {"amplitude": 1, "scale": 2}})",
         R"({"kind": "layers", "types": ["a", "b"], "thicknesses": [16, 32], )"
         R"("jitter": {"amplitude": 16, "scale": 32}})"}};
    for (const auto& [small, big] : pairs)
        EXPECT_EQ(test::types_of(*test::mixture_of(small, &frame), frame),
                  test::types_of(*test::mixture_of(big, &large), large))
            << small;
}

TEST(Perlin, ThresholdAndFraction)
{
    const ParticleFrame frame = test::random_spheres(300000, 2000);
    const auto fraction_of = [&](const std::string& json) {
        double first = 0;
        for (const uint32_t type : test::types_of(*test::mixture_of(json, &frame), frame)) first += type == 0;
        return first / double(frame.size());
    };
    EXPECT_NEAR(fraction_of(R"({"kind": "perlin", "types": ["a", "b"], "scale": 3, "threshold": 0})"), 0.5, 0.006);
    EXPECT_EQ(fraction_of(R"({"kind": "perlin", "types": ["a", "b"], "scale": 3, "threshold": 1.1})"), 1);
    for (const double f : {0.0, 0.02, 0.3, 0.75, 1.0}) {
        const double error = std::sqrt(f * (1 - f) * (1.0 / 300000 + 1.0 / (1 << 19)));
        for (const int octaves : {1, 4}) {
            const auto json = fmt::format(
                R"({{"kind": "perlin", "types": ["a", "b"], "scale": 3, "octaves": {}, "fraction": {}}})", octaves, f);
            EXPECT_NEAR(fraction_of(json), f, 4 * error) << json;
        }
    }
}

TEST(Perlin, FractionsOfThreeTypes)
{
    const ParticleFrame frame = test::random_spheres(300000, 2000);
    const auto mixture =
        test::mixture_of(R"({"kind": "perlin", "types": ["c", "a", "b"], "scale": 2, "fraction": [1, 1, 2]})", &frame);
    std::vector<double> count(3, 0);
    for (const uint32_t type : test::types_of(*mixture, frame)) count[type] += 1 / 300000.0;
    EXPECT_NEAR(count[2], 0.25, 0.005);
    EXPECT_NEAR(count[0], 0.25, 0.005);
    EXPECT_NEAR(count[1], 0.5, 0.005);
}

TEST(Layers, InOrderAndAgain)
{
    const auto mixture = test::mixture_of(R"({"kind": "layers", "types": ["a", "b", "c"], "thicknesses": [1, 2, 3],
                             "direction": [0, 0, 5], "offset": 10})",
                                          nullptr);
    for (int i = -30; i < 30; ++i) {
        const double z = i + 0.5, in = z - 10 - 6 * std::floor((z - 10) / 6);
        EXPECT_EQ(type_at(*mixture, {7, -3, static_cast<float>(z)}), in < 1 ? 0u : in < 3 ? 1u : 2u) << z;
    }
    const auto once = test::mixture_of(R"({"kind": "layers", "types": ["a", "b"], "thicknesses": 2,
                             "direction": [-1, 0, 0], "repeat": false})",
                                       nullptr);
    EXPECT_EQ(type_at(*once, {100, 0, 0}), 0u);
    EXPECT_EQ(type_at(*once, {-1.9f, 0, 0}), 0u);
    EXPECT_EQ(type_at(*once, {-2.1f, 0, 0}), 1u);
    EXPECT_EQ(type_at(*once, {-100, 0, 0}), 1u);
}

TEST(Layers, JitterMovesFacesByItsAmplitudeAtMost)
{
    const ParticleFrame frame = test::random_spheres(20000, 40);
    const auto plane = test::mixture_of(R"({"kind": "layers", "types": ["a", "b"], "thicknesses": 4})", &frame);
    const auto wavy = test::mixture_of(
        R"({"kind": "layers", "types": ["a", "b"], "thicknesses": 4, "jitter": {"amplitude": 1, "scale": 3}})", &frame);
    int moved = 0;
    for (size_t i = 0; i < frame.size(); ++i) {
        const V3f p = frame.relative_position(i);
        if (plane->type(i, p) == wavy->type(i, p)) continue;
        ++moved;
        const double to_face = std::abs(p.z / 4 - std::round(p.z / 4)) * 4;
        EXPECT_LT(to_face, 1.0);
    }
    EXPECT_GT(moved, 1000);
}

TEST(Radius, ByThresholds)
{
    ParticleFrame frame = test::random_spheres(4, 1);
    frame.radius = {0.1f, 0.5f, 0.7f, 3.0f};
    const auto mixture =
        test::mixture_of(R"({"kind": "radius", "types": ["a", "b", "c"], "thresholds": [0.5, 1]})", &frame);
    EXPECT_EQ(test::types_of(*mixture, frame), (std::vector<uint32_t>{0, 1, 1, 2}));
    EXPECT_TRUE(test::input_error_of(
        [] { test::mixture_of(R"({"kind": "radius", "types": ["a", "b"], "thresholds": [1]})", nullptr); }));
}

TEST(Radius, OfATileThatRepeats)
{
    ParticleFrame tile = test::random_spheres(3, 1);
    tile.radius = {0.1f, 0.5f, 0.7f};
    MixtureDescription description;
    description.kind = RadiusDescription{{"a", "b"}, {0.4}};
    const auto mixture = make_mixture(description, {{"a", "b"}, {}, &tile, true, "tile"});
    for (uint64_t i = 0; i < 30; ++i) EXPECT_EQ(mixture->type(i, {}), i % 3 == 0 ? 0u : 1u);
}

TEST(Grid, ChancesAreTheConcentrations)
{
    const test::TemporaryFolder folder;
    test::write_ramp(folder.path("ramp.vdb"), 11);
    // At x = 4.25 trilinear interpolation gives a concentration of 0.425.
    const auto mixture =
        test::mixture_of(R"({"kind": "grid", "fields": [{"type": "b", "file": "ramp.vdb", "grid": "c"}], "rest": "a"})",
                         nullptr, folder.path());
    double chosen = 0;
    constexpr int n = 200000;
    for (uint64_t i = 0; i < n; ++i) chosen += mixture->type(i, {4.25f, 3.5f, 6.75f});
    EXPECT_NEAR(chosen / n, 0.425, 4 * std::sqrt(0.425 * 0.575 / n) + 1e-7);
    for (uint64_t i = 0; i < 100; ++i) {
        EXPECT_EQ(mixture->type(i, {10, 5, 5}), 1u);
        EXPECT_EQ(mixture->type(i, {0, 5, 5}), 0u);
        EXPECT_EQ(mixture->type(i, {1e30f, 5, 5}), 0u);
    }
}

TEST(Grid, SeveralFieldsShareByTheirSum)
{
    const test::TemporaryFolder folder;
    test::write_ramp(folder.path("ramp.vdb"), 11);
    // The same field twice and no rest: half and half where the field is not 0, the first type where it is 0.
    const auto mixture = test::mixture_of(
        R"({"kind": "grid", "fields": [{"type": "c", "file": "ramp.vdb"}, {"type": "b", "file": "ramp.vdb"}]})",
        nullptr, folder.path());
    std::vector<double> count(4, 0);
    constexpr int n = 100000;
    for (uint64_t i = 0; i < n; ++i) count[mixture->type(i, {2, 5, 5})] += 1;
    EXPECT_NEAR(count[1] / n, 0.5, 4 * 0.5 / std::sqrt(n));
    EXPECT_EQ(count[1] + count[2], n);
    EXPECT_EQ(mixture->type(5, {0, 5, 5}), 2u);
}

TEST(Grid, MissingFilesAndGridsAreNamed)
{
    const test::TemporaryFolder folder;
    test::write_ramp(folder.path("ramp.vdb"), 4);
    folder.write("text.vdb", "no grid");
    for (const char* field : {R"("file": "none.vdb")", R"("file": "text.vdb")", R"("file": "ramp.vdb", "grid": "d")"}) {
        const std::string json = fmt::format(R"({{"kind": "grid", "fields": [{{"type": "a", {}}}]}})", field);
        const auto error = test::input_error_of([&] { test::mixture_of(json, nullptr, folder.path()); });
        ASSERT_TRUE(error) << json;
        EXPECT_NE(error->place().find(".vdb"), std::string::npos);
    }
}

TEST(Blend, PicksBetweenMixtures)
{
    const ParticleFrame frame = test::random_spheres(5000, 30);
    const auto mixture = test::mixture_of(R"({"kind": "blend",
        "by": {"kind": "layers", "types": ["core", "rim"], "thicknesses": [2, 3]},
        "mixtures": {"rim": {"kind": "blend", "by": {"kind": "explicit", "types": {"1": "m", "2": "n", "3": "m"}},
                             "mixtures": {"m": "b", "n": "c"}},
                     "core": "a"}})",
                                          &frame);
    for (size_t i = 0; i < frame.size(); ++i) {
        const V3f p = frame.relative_position(i);
        const double in = p.z - 5 * std::floor(p.z / 5.0);
        EXPECT_EQ(mixture->type(i, p), in < 2 ? 0u : frame.type[i] == 2 ? 2u : 1u);
    }
}

} // namespace
} // namespace scree
