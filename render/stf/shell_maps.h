#pragma once

#include "base/progress.h"
#include "render/stf/stf.h"

#include <array>

namespace scree {

/// How the squared cosines of directions to a normal are distributed: those of a cosine hemisphere are uniform.
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
    /// Of a bin; they sum to 1.
    double share(uint32_t bin) const { return weights_ > 0 ? share_[bin] / weights_ : 0; }
    /// Sum of |share - 1 / bins|, 0 to 2.
    double distance() const;
    /// What it would be in the mean for independent draws from a cosine hemisphere.
    double noise() const;

private:
    std::array<double, bins> share_{};
    double weights_ = 0, squares_ = 0;
};

/// Directions about a shell's normal in cells of equal projected solid angle: the disc of their tangential components
/// (x: along growing theta_t, y: across) mapped to the square by Shirley and Chiu's concentric map (1997).
///
/// Mirror images in y are equal, as they are in a shell.
class DirectionMap {
public:
    static constexpr uint32_t side = 24, cells = side * side; ///< x grows within a row of cells, y by the row

    DirectionMap() = default;
    /// counts: by cell.
    explicit DirectionMap(const std::array<uint64_t, cells>& counts);

    /// Of tangential components x, y within the unit disc.
    static uint32_t cell(double x, double y);
    /// The middle of a cell on the disc.
    static V2d centre(uint32_t cell);

    uint64_t count() const { return count_; }
    /// Per projected solid angle: a cosine hemisphere is 1 / pi everywhere.
    double density(uint32_t cell) const { return density_[cell]; }
    /// The same between the cells' middles.
    double density_at(double x, double y) const;
    /// The largest per solid angle, over that of a cosine hemisphere.
    double peak() const;

private:
    uint64_t count_ = 0;
    std::array<double, cells> density_{};
};

/// Where light goes that leaves a shell after two scatterings and more, by the place it leaves at.
struct ShellMaps {
    static constexpr uint32_t rows =
        6; ///< bins of equal width of cos theta_t, from 1 down to -1: of equal area on the shell

    double radius = 0; ///< in mean free paths
    uint64_t walks = 0; ///< that leave after two scatterings and more
    double mean_cosine = 0; ///< to the normal
    CosineDistance distance;
    std::array<DirectionMap, rows> by_theta{};
};

/// Makes as many such walks, by those of the smaller shells of `stf`, which must be there; the same for any number of
/// threads.
///
/// number: of the shell. walks: 1 .. 2^32. Throws Cancelled.
ShellMaps map_shell(const Stf& stf, size_t number, uint64_t walks, uint64_t seed, const Progress& progress);

} // namespace scree
