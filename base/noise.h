#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// Improved noise (Perlin 2002): smooth, about -1..1, 0 at whole numbers, of period 256 along each axis.
///
/// With X = floor(x) mod 256, x its fraction and f(t) = t^3 (t (6 t - 15) + 10): trilinear interpolation by f(x), f(y),
/// f(z), along x first, then y, then z, of the dot products of the offsets from the cell's corners with their
/// gradients; corner (X, Y, Z) has gradient number p[p[p[X] + Y] + Z] mod 16, where p is the published permutation of
/// 0..255, indices taken mod 256, and the gradients are the 12 edges of the cube, four of them twice. In double and in
/// this order: the same bits everywhere; noise(3.14, 42, 7) = 0.13691995878400012. Places past 2^52 give 0.
double improved_noise(double x, double y, double z);

/// How octaves of noise are laid over a place.
struct NoiseOptions {
    Imath::V3d scale{1}; ///< lattice width of the first octave, per axis, in units of length
    Imath::V3d offset{0}; ///< added after scaling, in lattice cells
    int octaves = 1;
    double lacunarity = 2; ///< frequency of an octave over that of the one before
    double gain = 0.5; ///< amplitude of an octave over that of the one before
    uint64_t seed = 0; ///< 0: octave 0 is not shifted, so that it is improved_noise itself
};

/// Sum of octaves of improved noise over the sum of their amplitudes.
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

    /// The values below which each of the given fractions (in 0..1) of space lies.
    ///
    /// From 2^19 places spread evenly over the noise's period; standard error of a fraction below 0.0007.
    std::vector<double> quantiles(std::span<const double> fractions) const;
    /// The fraction of space below each of the given values; the same places.
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
