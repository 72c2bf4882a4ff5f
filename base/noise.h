#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Improved noise (Perlin 2002): smooth, about -1..1, 0 at integer points, period 256 along each axis.
///
/// Let X = floor(x) mod 256 and x be replaced by its fraction; the same for y and z. Corner (X, Y, Z) of the cell has
/// gradient number p[p[p[X] + Y] + Z] mod 16; p is the published permutation of 0..255, its indices are taken mod 256,
/// and the gradients are the 12 edges of the cube, four of them twice. The noise interpolates the dot products of the
/// gradients with the offsets from their corners: trilinearly by f(x), f(y), f(z), along x first, then y, then z, where
/// f(t) = t^3 (t (6 t - 15) + 10). Double precision and this order give the same bits everywhere:
/// noise(3.14, 42, 7) = 0.13691995878400012. Coordinates past 2^52 give 0.
double improved_noise(double x, double y, double z);

/// Parameters of FractalNoise.
struct NoiseOptions {
    Imath::V3d scale{1}; ///< lattice width of the first octave, per axis, in units of length
    Imath::V3d offset{0}; ///< added after scaling, in lattice cells
    int octaves = 1;
    double lacunarity = 2; ///< frequency of an octave over the frequency of the previous octave
    double gain = 0.5; ///< amplitude of an octave over the amplitude of the previous octave
    uint64_t seed = 0; ///< 0: octave 0 is not shifted, so it equals improved_noise
};

/// Sum of octaves of improved noise, divided by the sum of their amplitudes.
///
/// Octave k is gain^k noise(lacunarity^k (p / scale + offset) + s_k). The shift s_k keeps the zeros of the octaves
/// apart: component a is 256 unit_double(hash_index(3 k + a, seed, 0x6e6f697365)), and 0 for k = 0 and seed 0.
class FractalNoise {
public:
    explicit FractalNoise(const NoiseOptions& options);

    double operator()(const Imath::V3d& place) const
    {
        const Imath::V3d q(place.x / scale_.x + offset_.x, place.y / scale_.y + offset_.y,
                           place.z / scale_.z + offset_.z);
        double sum = 0;
        for (const Octave& o : octaves_) {
            const Imath::V3d r = q * o.frequency + o.shift;
            sum += o.amplitude * improved_noise(r.x, r.y, r.z);
        }
        return sum;
    }

    /// For each given fraction (0..1), the value v such that the noise is below v in that fraction of space.
    ///
    /// From 2^19 points spread evenly over the noise's period; the standard error of a fraction is below 0.0007.
    std::vector<double> quantiles(std::span<const double> fractions) const;
    /// The fraction of space where the noise is below each given value, from the same points.
    std::vector<double> fractions_below(std::span<const double> values) const;

private:
    struct Octave {
        double frequency, amplitude; // amplitudes sum to 1
        Imath::V3d shift;
    };
    std::vector<double> sample() const;

    Imath::V3d scale_, offset_;
    std::vector<Octave> octaves_;
};

} // namespace scree
