#include "base/noise.h"

#include "base/hash.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace scree {

namespace {

/// Perlin 2002, the published permutation.
constexpr std::array<uint8_t, 256> permutation{
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

/// Gradients 0..15. A product with 0 adds exactly nothing, so the dot product has the same bits as +-u +- v.
constexpr std::array<std::array<double, 3>, 16> gradients{{{1, 1, 0},
                                                           {-1, 1, 0},
                                                           {1, -1, 0},
                                                           {-1, -1, 0},
                                                           {1, 0, 1},
                                                           {-1, 0, 1},
                                                           {1, 0, -1},
                                                           {-1, 0, -1},
                                                           {0, 1, 1},
                                                           {0, -1, 1},
                                                           {0, 1, -1},
                                                           {0, -1, -1},
                                                           {1, 1, 0},
                                                           {0, -1, 1},
                                                           {-1, 1, 0},
                                                           {0, -1, -1}}};

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double lerp(double t, double a, double b) { return a + t * (b - a); }

double along_gradient(unsigned hash, double x, double y, double z)
{
    const auto& g = gradients[hash & 15];
    return g[0] * x + g[1] * y + g[2] * z;
}

/// floor mod 256; |floor| is below 2^52.
unsigned wrap(double floor) { return static_cast<unsigned>(static_cast<int64_t>(floor) & 255); }

constexpr size_t sample_count = size_t{1} << 19;

} // namespace

double improved_noise(double x, double y, double z)
{
    constexpr double limit = 0x1p52; // from here on all doubles are whole numbers
    if (!(std::abs(x) < limit && std::abs(y) < limit && std::abs(z) < limit)) return 0;
    const double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
    const unsigned X = wrap(fx), Y = wrap(fy), Z = wrap(fz);
    x -= fx;
    y -= fy;
    z -= fz;
    const auto p = [](unsigned i) -> unsigned { return permutation[i & 255]; };
    const unsigned A = p(X) + Y, B = p(X + 1) + Y;
    const unsigned AA = p(A) + Z, AB = p(A + 1) + Z, BA = p(B) + Z, BB = p(B + 1) + Z;
    const double u = fade(x), v = fade(y), w = fade(z);
    const double low = lerp(v, lerp(u, along_gradient(p(AA), x, y, z), along_gradient(p(BA), x - 1, y, z)),
                            lerp(u, along_gradient(p(AB), x, y - 1, z), along_gradient(p(BB), x - 1, y - 1, z)));
    const double high =
        lerp(v, lerp(u, along_gradient(p(AA + 1), x, y, z - 1), along_gradient(p(BA + 1), x - 1, y, z - 1)),
             lerp(u, along_gradient(p(AB + 1), x, y - 1, z - 1), along_gradient(p(BB + 1), x - 1, y - 1, z - 1)));
    return lerp(w, low, high);
}

FractalNoise::FractalNoise(const NoiseOptions& options) : scale_(options.scale), offset_(options.offset)
{
    constexpr uint64_t stream = 0x6e6f697365; // "noise"
    double frequency = 1, amplitude = 1, sum = 0;
    for (int k = 0; k < options.octaves; ++k) {
        Octave octave{frequency, amplitude, Imath::V3d(0)};
        if (k > 0 || options.seed != 0) {
            for (int a = 0; a < 3; ++a) {
                octave.shift[a] = 256 * unit_double(hash_index(static_cast<uint64_t>(3 * k + a), options.seed, stream));
            }
        }
        octaves_.push_back(octave);
        sum += amplitude;
        frequency *= options.lacunarity;
        amplitude *= options.gain;
    }
    for (Octave& octave : octaves_) octave.amplitude /= sum;
}

std::vector<double> FractalNoise::sample() const
{
    // The additive recurrence of the root of g^4 = g + 1 fills the cube evenly (Roberts 2018). The scale and the offset
    // do not change the fractions of space, so they are dropped.
    constexpr double g = 1.2207440846057596;
    const FractalNoise unit = [this] {
        FractalNoise copy = *this;
        copy.scale_ = Imath::V3d(1);
        copy.offset_ = Imath::V3d(0);
        return copy;
    }();
    const Imath::V3d step(1 / g, 1 / (g * g), 1 / (g * g * g));
    std::vector<double> values(sample_count);
    for (size_t i = 0; i < sample_count; ++i) {
        Imath::V3d p = step * static_cast<double>(i);
        for (int a = 0; a < 3; ++a) p[a] = 256 * (p[a] - std::floor(p[a]));
        values[i] = unit(p);
    }
    return values;
}

std::vector<double> FractalNoise::quantiles(std::span<const double> fractions) const
{
    std::vector<double> values, result;
    for (const double f : fractions) {
        // The fractions 0 and 1 must be exact, even if the sample missed the extremes of the noise.
        if (f <= 0 || f >= 1) {
            result.push_back(f <= 0 ? -2 : 2);
            continue;
        }
        if (values.empty()) values = sample();
        const auto nth = values.begin() + static_cast<std::ptrdiff_t>(f * static_cast<double>(values.size()));
        std::nth_element(values.begin(), nth, values.end());
        result.push_back(*nth);
    }
    return result;
}

std::vector<double> FractalNoise::fractions_below(std::span<const double> thresholds) const
{
    const std::vector<double> values = sample();
    std::vector<double> result;
    for (const double t : thresholds) {
        const auto below = std::ranges::count_if(values, [t](double value) { return value < t; });
        result.push_back(static_cast<double>(below) / static_cast<double>(values.size()));
    }
    return result;
}

} // namespace scree
