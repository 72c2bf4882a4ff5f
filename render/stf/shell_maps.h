#pragma once

#include "base/progress.h"
#include "render/stf/stf.h"

#include <array>

namespace scree {

/// The distribution of the squared cosine between directions and a normal; it is uniform for a cosine hemisphere.
class CosineDistance {
public:
    static constexpr uint32_t bins = 16;

    void add(double squared_cosine, double weight)
    {
        share_[std::min(bins - 1, static_cast<uint32_t>(squared_cosine * bins))] += weight;
        weights_ += weight;
        squares_ += weight * weight;
    }
    void add(const CosineDistance& other);
    /// Share of a bin; all shares sum to 1.
    double share(uint32_t bin) const { return weights_ > 0 ? share_[bin] / weights_ : 0; }
    /// Sum of |share - 1 / bins|, 0 to 2.
    double distance() const;
    /// Mean of distance() for as many independent draws from a cosine hemisphere.
    double noise() const;

private:
    std::array<double, bins> share_{};
    double weights_ = 0, squares_ = 0;
};

/// Directions about a shell's normal in cells of equal projected solid angle: the disc of their tangential components
/// (x: along growing theta_t, y: across) mapped to the square by Shirley and Chiu's concentric map (1997).
///
/// Mirror images in y are averaged, because a shell has this symmetry.
class DirectionMap {
public:
    static constexpr uint32_t side = 24, cells = side * side; ///< x grows within a row of cells, y by the row

    DirectionMap() = default;
    /// counts: by cell.
    explicit DirectionMap(const std::array<uint64_t, cells>& counts);

    /// The cell of tangential components x, y within the unit disc.
    static uint32_t cell(double x, double y);
    /// The middle of a cell on the disc.
    static V2d centre(uint32_t cell);

    uint64_t count() const { return count_; }
    /// Density per projected solid angle; 1 / pi everywhere for a cosine hemisphere.
    double density(uint32_t cell) const { return density_[cell]; }
    /// The same density, interpolated between the cells' middles.
    double density_at(double x, double y) const;
    /// The largest density per solid angle, over the largest of a cosine hemisphere.
    double peak() const;

private:
    uint64_t count_ = 0;
    std::array<double, cells> density_{};
};

/// Directions of light that leaves a shell after at least two scatterings, by the angle theta_t of the place where it
/// leaves: the paper's p_s^{m, omega_s}.
struct ShellMaps {
    /// Bins of equal width in cos theta_t, from 1 down to -1: of equal area on the shell.
    static constexpr uint32_t rows = 6;

    double radius = 0; ///< the paper's r, in mean free paths
    uint64_t walks = 0; ///< that leave after at least two scatterings
    double mean_cosine = 0; ///< to the normal
    CosineDistance distance;
    std::array<DirectionMap, rows> by_theta{};
};

/// Maps one shell by new walks through the smaller shells of `stf`, which must be there; the same for any number of
/// threads.
///
/// number: of the shell. walks: number of walks that leave after at least two scatterings, 1 .. 2^32. Throws Cancelled.
ShellMaps map_shell(const Stf& stf, size_t number, uint64_t walks, uint64_t seed, const Progress& progress);

} // namespace scree
