#pragma once

#include "base/progress.h"
#include "render/media/medium.h"

#include <algorithm>
#include <array>
#include <vector>

namespace scree {

/// Mean coefficients of a medium over a part of it.
struct MediumMean {
    double sigma_t = 0;
    Weight albedo{1}; ///< weighted by sigma_t
    double g = 0; ///< weighted by what the brightest channel scatters
};

/// Means of an achromatic grid medium over cubes of growing size, and its variation inside them. They tell where the
/// medium is homogeneous enough for light that travels a long distance. Variation over short distances averages out and
/// is ignored.
class MediumPyramid {
public:
    /// box: bounds of the points that will be queried; render coordinates. tolerance: of sigma_t, 1 - albedo and 1 - g,
    /// relative to their means; it limits both the deviation of the means over the eight parts of a cube and twice the
    /// standard deviation over the cube. thin: variation inside cubes less than `thin` mean free paths wide is ignored.
    /// Throws Cancelled.
    MediumPyramid(const Medium& medium, const Imath::Box3d& box, double tolerance, double thin,
                  const Progress& progress);

    /// Whether the medium is homogeneous in a ball, within the tolerance. mean: set to the approximate mean over the
    /// ball.
    bool is_same(const V3d& centre, double radius, MediumMean& mean) const
    {
        return is_same(centre, radius, level_of(radius), mean);
    }
    /// Halves a ball's radius until the medium is homogeneous in it; false if no radius of a mean free path or more is
    /// found. Same result as calling is_same() for each radius, but almost free where there is no such ball.
    bool halve_until_same(const V3d& centre, double& radius, MediumMean& mean) const;

    /// The range of the means over small cubes; the albedo is that of the brightest channel. No mean of MediumMean
    /// exceeds sigma_t_high or albedo_high.
    struct Extremes {
        double sigma_t_high = 0, albedo_low = 1, albedo_high = 0, g_low = 1, g_high = -1;
    };
    const Extremes& extremes() const { return extremes_; }
    uint64_t bytes() const;

private:
    /// Means over a cube, the range of the means of its eight parts, and means of squares over all variation that does
    /// not average out.
    struct Cell {
        /// Extinction; extinction times 1 - albedo, per channel; scattering of the brightest channel times g.
        Real sigma_t = 0, lost[3] = {0, 0, 0}, forward = 0;
        /// Ranges of sigma_t, 1 - albedo and 1 - g.
        Real sigma_low = 0, sigma_high = 0, loss_low = 0, loss_high = 0, back_low = 0, back_high = 0;
        /// Mean squares: of sigma_t; of 1 - albedo, weighted by sigma_t; of 1 - g, weighted by the scattering of the
        /// brightest channel.
        Real sigma_square = 0, loss_square = 0, back_square = 0;

        Real least_lost() const { return std::min({lost[0], lost[1], lost[2]}); }
        Real brightest() const { return sigma_t - least_lost(); }
        Real loss() const { return sigma_t > 0 ? least_lost() / sigma_t : 0; }
        Real back() const { return brightest() > 0 ? 1 - forward / brightest() : 1; }
        double variance() const { return double{sigma_square} - double{sigma_t} * sigma_t; } ///< of sigma_t
        /// Adds another cell with a weight; the ranges become the union of both.
        void add(const Cell& other, Real weight);
        /// Sets the ranges, or the squares, to those of a homogeneous cell with the same means.
        void forget_range();
        void forget_squares();
    };
    struct Level {
        double width = 0; ///< edge of a cube
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
    /// The level for balls of a radius: the finest whose cubes are at least as wide as the ball.
    size_t level_of(double radius) const;
    bool is_same(const V3d& centre, double radius, size_t level, MediumMean& mean) const;
    /// Whether low and high can both be within the tolerance of one mean sigma_t.
    bool may_be_close(double low, double high) const { return high * (1 - most_off_) <= low * (1 + most_off_); }
    /// Whether a ball of `level`, with a radius of a mean free path or more and its centre in this cube of the level
    /// `finer`, can be homogeneous: false only if no such ball is.
    bool may_hold(size_t level, size_t finer, const std::array<int64_t, 3>& cube) const;
    /// The least variance of sigma_t in any cube of the first level that a ball with its centre in this cube can
    /// overlap.
    double least_variance_around(const std::array<int64_t, 3>& cube) const;
    void fill_promising();

    V3d origin_{0};
    double width_ = 0; ///< edge of a cube of the first level
    double tolerance_, most_off_;
    Extremes extremes_;
    std::vector<Level> levels_;
    /// For each cube of the first level: bit l is set if may_hold() is true for balls of level l centred in this cube.
    std::vector<uint32_t> promising_;
};

} // namespace scree
