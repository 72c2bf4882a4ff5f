#include "base/noise.h"
#include "tests/mixtures/mixture_builders.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace scree {
namespace {

/// The same noise in another form: a weighted sum over the eight corners, where the bits of the hash choose the
/// gradient's dot product (Perlin 2002). The permutation is rebuilt from its cycles, below.
class Reference {
public:
    Reference()
    {
        // One line per cycle: the permutation maps every number to the next one.
        for (const auto& cycle : cycles())
            for (size_t k = 0; k < cycle.size(); ++k) p_[static_cast<size_t>(cycle[k])] = cycle[(k + 1) % cycle.size()];
    }

    double operator()(double x, double y, double z) const
    {
        const double at[3] = {x, y, z};
        int cell[3];
        double t[3], s[3];
        for (int a = 0; a < 3; ++a) {
            const double below = std::floor(at[a]);
            cell[a] = static_cast<int>(below - 256 * std::floor(below / 256));
            t[a] = at[a] - below;
            s[a] = 6 * std::pow(t[a], 5) - 15 * std::pow(t[a], 4) + 10 * std::pow(t[a], 3);
        }
        double sum = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const int d[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
            double weight = 1;
            for (int a = 0; a < 3; ++a) weight *= d[a] ? s[a] : 1 - s[a];
            const int hash = p((p((p((cell[0] + d[0]) & 255) + cell[1] + d[1]) & 255) + cell[2] + d[2]) & 255);
            sum += weight * gradient(hash, t[0] - d[0], t[1] - d[1], t[2] - d[2]);
        }
        return sum;
    }

private:
    int p(int i) const { return p_[static_cast<size_t>(i)]; }

    static double gradient(int hash, double x, double y, double z)
    {
        const int h = hash & 15;
        const double u = h < 8 ? x : y, v = h < 4 ? y : h == 12 || h == 14 ? x : z;
        return ((h & 1) ? -u : u) + ((h & 2) ? -v : v);
    }

    static std::vector<std::vector<int>> cycles();

    std::array<int, 256> p_{};
};

std::vector<std::vector<int>> Reference::cycles()
{
    return {
        {0, 151, 17, 36},
        {1,   160, 119, 86,  92,  244, 24,  37,  26,  21,  142, 85,  105, 76,  83,  230, 50,  33,  120, 164, 44,
         117, 188, 178, 39,  62,  68,  139, 126, 3,   91,  40,  94,  143, 212, 249, 195, 228, 115, 130, 226, 204,
         191, 104, 209, 51,  88,  55,  87,  41,  252, 215, 107, 187, 232, 127, 64,  74,  158, 170, 101, 216, 49,
         177, 22,  8,   201, 210, 145, 206, 162, 152, 182, 108, 208, 81,  211, 235, 254, 156, 223, 157, 183, 110,
         18,  103, 73,  146, 59,  136, 38,  197, 34,  234, 150, 58,  125, 186, 224, 184, 79,  122, 109, 89,  46,
         11,  53,  149, 16,  140, 255, 180, 19,  30,  6,   131, 250, 78,  229, 121, 100},
        {2,   137, 147, 227, 176, 129, 217, 192, 218, 214, 239, 93,  102, 80,  60, 171, 155, 42,
         219, 31,  148, 47,  32,  247, 141, 82,  133, 123, 198, 242, 67,  134, 5,  15,  225, 84,
         220, 181, 98,  63,  175, 9,   95,  54,  56,  174, 172, 167, 70,  27,  10, 96,  65,  165,
         154, 28,  23,  99,  161, 248, 128, 52,  237, 236, 138, 118, 159, 213, 14, 7,   13,  233,
         4,   90,  245, 72,  77,  111, 169, 153, 189, 185, 113, 196, 251, 66,  71, 166, 163},
        {12, 194, 97, 25, 240, 222, 106, 132, 124, 173, 43, 203},
        {20, 69, 48, 57},
        {29, 190, 112, 200, 238, 205, 179, 253, 61, 168, 221, 199, 193, 246, 243},
        {35, 75, 231, 45},
        {114, 135, 202, 144, 207, 241},
        {116},
    };
}

TEST(Noise, ReferenceValue) { EXPECT_EQ(improved_noise(3.14, 42, 7), 0.13691995878400012); }

TEST(Noise, AThousandPointsAgainstAnIndependentImplementation)
{
    const Reference reference;
    test::Numbers numbers(11);
    for (int i = 0; i < 1000; ++i) {
        const double range = i % 2 ? 600 : 4;
        const double x = range * (numbers.unit() - 0.5), y = range * (numbers.unit() - 0.5),
                     z = range * (numbers.unit() - 0.5);
        // The reference computes its weights as sums of powers, so rounding differs.
        EXPECT_NEAR(improved_noise(x, y, z), reference(x, y, z), 4e-14) << x << " " << y << " " << z;
    }
}

TEST(Noise, IsZeroOnTheLatticeAndPeriodic)
{
    for (int i = -300; i < 300; i += 7) EXPECT_EQ(improved_noise(i, 2 * i + 1, 5 - i), 0);
    EXPECT_EQ(improved_noise(0.25, 0.5, 0.75), improved_noise(256.25, -255.5, 512.75));
}

TEST(Noise, PlacesBeyondCountingGiveZero)
{
    const double inf = std::numeric_limits<double>::infinity();
    for (const double x : {1e17, -1e300, inf, -inf, std::nan("")}) EXPECT_EQ(improved_noise(x, 0.5, 0.5), 0);
    NoiseOptions options;
    options.scale = Imath::V3d(1e-320);
    options.octaves = 4;
    EXPECT_TRUE(std::isfinite(FractalNoise(options)({1, 2, 3})));
}

TEST(Noise, OneOctaveIsTheNoiseItself)
{
    NoiseOptions options;
    options.scale = {2, 4, 0.5};
    options.offset = {1, 2, 3};
    EXPECT_EQ(FractalNoise(options)({4.28, 160, 2}), improved_noise(3.14, 42, 7));
}

TEST(Noise, QuantilesHoldTheirFractionsOfSpace)
{
    test::Numbers numbers(5);
    for (const int octaves : {1, 3}) {
        NoiseOptions options;
        options.octaves = octaves;
        options.seed = 9;
        options.scale = Imath::V3d(3);
        const FractalNoise noise(options);
        const std::vector<double> fractions{0, 0.05, 0.3, 0.5, 0.9, 1};
        const std::vector<double> thresholds = noise.quantiles(fractions);
        constexpr int n = 200000;
        std::vector<int> below(fractions.size(), 0);
        for (int i = 0; i < n; ++i) {
            const double value = noise({1e4 * numbers.unit(), 1e4 * numbers.unit(), 1e4 * numbers.unit()});
            for (size_t k = 0; k < fractions.size(); ++k) below[k] += value < thresholds[k];
        }
        for (size_t k = 0; k < fractions.size(); ++k) {
            const double f = fractions[k], error = std::sqrt(f * (1 - f) * (1.0 / n + 1.0 / (1 << 19)));
            EXPECT_NEAR(below[k] / double(n), f, 4 * error + 1e-12) << octaves << " octaves";
        }
        const std::vector<double> back = noise.fractions_below(thresholds);
        for (size_t k = 0; k < fractions.size(); ++k) EXPECT_NEAR(back[k], fractions[k], 1e-5);
    }
}

} // namespace
} // namespace scree
