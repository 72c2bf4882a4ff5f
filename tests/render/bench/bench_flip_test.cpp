// FLIP of pairs whose answer is known from its definition.

#include "render/bench/flip.h"

#include <gmock/gmock.h>

#include <random>

namespace scree {
namespace {

constexpr int side = 40;

ScreenPicture picture_of(const std::function<V3d(int, int)>& color)
{
    ScreenPicture picture{side, side, {}};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) picture.pixels.push_back(color(x, y));
    return picture;
}

ScreenPicture plain(const V3d& color)
{
    return picture_of([&](int, int) { return color; });
}

ScreenPicture random_picture(uint64_t seed)
{
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u;
    return picture_of([&](int, int) { return V3d(u(random), u(random), u(random)); });
}

TEST(Flip, IsNothingBetweenAPictureAndItself)
{
    const ScreenPicture picture = random_picture(1);
    for (const double v : flip_difference(picture, picture)) EXPECT_EQ(v, 0);
}

TEST(Flip, TakesBlackAndWhiteAsFarApart)
{
    // Plain pictures have no features, and HyAB of black and white is 100: 100^0.7 lies between the knee at 0.4 and the
    // maximum, 41.2761, the difference of green and blue.
    const double knee = 0.4 * 41.2761, expected = 0.95 + (std::pow(100, 0.7) - knee) / (41.2761 - knee) * 0.05;
    for (const double v : flip_difference(plain(V3d(0)), plain(V3d(1)))) EXPECT_NEAR(v, expected, 1e-4);
    EXPECT_NEAR(mean_flip(flip_difference(plain({0, 1, 0}), plain({0, 0, 1}))), 1, 1e-9);
}

TEST(Flip, GrowsWithContrast)
{
    double last = 0;
    for (const double step : {0.01, 0.03, 0.1, 0.3, 0.5}) {
        const double flip = mean_flip(flip_difference(plain(V3d(0.5)), plain(V3d(0.5 + step))));
        EXPECT_GT(flip, last);
        last = flip;
    }
}

TEST(Flip, StaysBetweenNothingAndOneAndIsTheSameBothWays)
{
    const ScreenPicture a = random_picture(2), b = random_picture(3);
    const std::vector<double> ab = flip_difference(a, b), ba = flip_difference(b, a);
    for (size_t i = 0; i < ab.size(); ++i) {
        EXPECT_GE(ab[i], 0);
        EXPECT_LE(ab[i], 1);
        EXPECT_DOUBLE_EQ(ab[i], ba[i]);
    }
}

TEST(Flip, SeesAFineCheckerboardOnlyFromNear)
{
    const ScreenPicture board = picture_of([](int x, int y) { return V3d((x + y) % 2 ? 0.6 : 0.4); });
    const double far = mean_flip(flip_difference(plain(V3d(0.5)), board, 120)),
                 near = mean_flip(flip_difference(plain(V3d(0.5)), board, 10));
    EXPECT_LT(far, 0.02);
    EXPECT_GT(near, 5 * far);
}

TEST(Flip, CountsAnEdgeForMoreThanItsColour)
{
    const ScreenPicture with_edge = picture_of([](int x, int) { return V3d(x < side / 2 ? 0.45 : 0.55); });
    const std::vector<double> map = flip_difference(plain(V3d(0.5)), with_edge);
    const auto row = map.begin() + side * side / 2;
    const double at_edge = std::max(row[side / 2 - 2], row[side / 2 + 2]);
    EXPECT_GT(at_edge, 1.2 * row[1]);
}

TEST(Flip, CutsWhatAScreenCannotShow) { EXPECT_EQ(mean_flip(flip_difference(plain(V3d(1)), plain(V3d(7)))), 0); }

} // namespace
} // namespace scree
