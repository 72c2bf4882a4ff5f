#pragma once

#include "base/progress.h"
#include "render/media/medium.h"

#include <algorithm>
#include <array>
#include <vector>

namespace scree {

/// What a medium is in the mean over a part of it.
struct MediumMean {
    double sigma_t = 0;
    Weight albedo{1}; ///< by what it scatters
    double g = 0; ///< likewise
};

/// Means of an achromatic medium of grids over cubes of growing size, and how much it varies within: where it counts as
/// the same for light that goes a long way. What varies over a short way averages out, and does not count.
class MediumPyramid {
public:
    /// box: where places will be asked about; render coordinates. tolerance: of sigma_t, 1 - albedo and 1 - g, as parts
    /// of their means: what the means of eight parts of a cube may be off by, and twice the standard deviation of all
    /// that is in it. thin: mean free paths across cubes in which what varies does not count. Throws Cancelled.
    MediumPyramid(const Medium& medium, const Imath::Box3d& box, double tolerance, double thin,
                  const Progress& progress);

    /// Whether the medium is the same in a ball, within the tolerance; mean: over the ball, about.
    bool is_same(const V3d& centre, double radius, MediumMean& mean) const
    {
        return is_same(centre, radius, level_of(radius), mean);
    }
    /// Halves a ball's radius until the medium is the same in it; false: in none with a radius of a mean free path or
    /// more. Finds what asking is_same() of each would, at next to no cost where there is none.
    bool halve_until_same(const V3d& centre, double& radius, MediumMean& mean) const;

    /// Between which its means over small cubes lie; of the albedo that of the brightest channel. No mean is above the
    /// highest sigma_t and albedo.
    struct Extremes {
        double sigma_t_high = 0, albedo_low = 1, albedo_high = 0, g_low = 1, g_high = -1;
    };
    const Extremes& extremes() const { return extremes_; }
    uint64_t bytes() const;

private:
    /// Means over a cube, the range of those of the eight cubes within, and means of squares over all that does not
    /// average out.
    struct Cell {
        Real sigma_t = 0, lost[3] = {0, 0, 0},
             forward = 0; ///< extinction; times 1 - albedo; what the brightest channel scatters, times g
        Real sigma_low = 0, sigma_high = 0, loss_low = 0, loss_high = 0, back_low = 0,
             back_high = 0; ///< of sigma_t, 1 - albedo, 1 - g
        Real sigma_square = 0, loss_square = 0,
             back_square = 0; ///< of sigma_t; of the others, times sigma_t and times what is scattered

        Real least_lost() const { return std::min({lost[0], lost[1], lost[2]}); }
        Real brightest() const { return sigma_t - least_lost(); }
        Real loss() const { return sigma_t > 0 ? least_lost() / sigma_t : 0; }
        Real back() const { return brightest() > 0 ? 1 - forward / brightest() : 1; }
        double variance() const { return double{sigma_square} - double{sigma_t} * sigma_t; } ///< of sigma_t
        /// Adds what is in another; the ranges become those of both.
        void add(const Cell& other, Real weight);
        /// As if it were the same all over.
        void forget_range();
        void forget_squares();
    };
    struct Level {
        double width = 0; ///< of a cube
        std::array<int64_t, 3> size{};
        std::vector<Cell> cells;
        size_t index(int64_t x, int64_t y, int64_t z) const
        {
            return static_cast<size_t>((x * size[1] + y) * size[2] + z);
        }
        const Cell& at(int64_t x, int64_t y, int64_t z) const { return cells[index(x, y, z)]; }
    };
    static Cell cell_at(const Medium& medium, const V3d& place);
    void add_level();
    /// Of balls of a radius: its cubes are as wide as they are.
    size_t level_of(double radius) const;
    bool is_same(const V3d& centre, double radius, size_t level, MediumMean& mean) const;
    /// Whether all sigma_t between these can be within the tolerance of one.
    bool may_be_close(double low, double high) const { return high * (1 - most_off_) <= low * (1 + most_off_); }
    /// Whether a ball of a level can be the same, with a radius of a mean free path, if its centre is in this cube of
    /// the level `finer`: false only if none is.
    bool may_hold(size_t level, size_t finer, const std::array<int64_t, 3>& cube) const;
    /// Of sigma_t within any cube of the first level that a ball may meet with its centre in this one.
    double least_variance_around(const std::array<int64_t, 3>& cube) const;
    void fill_promising();

    V3d origin_{0};
    double width_ = 0; ///< of a cube of the first level
    double tolerance_, most_off_;
    Extremes extremes_;
    std::vector<Level> levels_;
    std::vector<uint32_t> promising_; ///< by cube of the first level: a bit for each level of which balls around places
                                      ///< in there may_hold()
};

} // namespace scree
