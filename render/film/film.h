#pragma once

#include "base/math.h"
#include "render/film/halves.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace scree {

inline constexpr uint32_t no_grain = std::numeric_limits<uint32_t>::max(); ///< type and id where there is no grain

/// What a path hit first, for the auxiliary channels.
struct FirstHit {
    bool hit = false;
    Color albedo{0};
    V3f normal{0};
    double depth = 0; ///< along the view, render coordinates
    uint32_t type = no_grain;
    uint64_t id = no_grain;
};

/// A pixel's running sums; double, so that 2^20 samples add without loss.
struct Pixel {
    uint32_t drawn = 0; ///< samples taken
    uint32_t samples = 0; ///< finite ones among the drawn: the others are dropped
    uint32_t hits = 0; ///< finite samples whose path hit something
    Imath::V3d sum{0}, sum_of_squares{0};
    Color albedo{0};
    V3f normal{0};
    double depth = 0;
    uint32_t type = no_grain, id = no_grain; ///< of the first sample

    void add(const Color& radiance, const FirstHit& first);
    Color mean() const;
    /// Variance of the mean, per channel; 0 below two samples.
    Color variance() const;
};

/// The pixels of the rendered part of a picture, row by row.
class Film {
public:
    /// x0..x1, y0..y1: pixels rendered (x1, y1 excluded) of a width x height picture.
    Film(int width, int height, int x0, int y0, int x1, int y1);

    int width() const { return width_; }
    int height() const { return height_; }
    int x0() const { return x0_; }
    int y0() const { return y0_; }
    int x1() const { return x1_; }
    int y1() const { return y1_; }
    Pixel& at(int x, int y) { return pixels_[index(x, y)]; }
    const Pixel& at(int x, int y) const { return pixels_[index(x, y)]; }
    std::vector<Pixel>& pixels() { return pixels_; }
    const std::vector<Pixel>& pixels() const { return pixels_; }

    /// Also keeps the two halves of the samples, not only their sum; to be called before the first sample.
    void keep_halves();
    /// In the order of pixels(); empty unless halves are kept.
    std::vector<PixelHalves>& halves() { return halves_; }
    const std::vector<PixelHalves>& halves() const { return halves_; }
    PixelHalves& halves_at(int x, int y) { return halves_[index(x, y)]; }
    const PixelHalves& halves_at(int x, int y) const { return halves_[index(x, y)]; }
    /// Replaces the pixels' values and variances, which are of all samples, by those of their halves.
    void take_halves();

    static constexpr int tile_size = 16;
    int tile_columns() const { return (x1_ - x0_ + tile_size - 1) / tile_size; }
    int tile_rows() const { return (y1_ - y0_ + tile_size - 1) / tile_size; }
    /// The tiles, row by row; empty unless halves are kept.
    TileStates& tile_states() { return tile_states_; }
    const TileStates& tile_states() const { return tile_states_; }

private:
    size_t index(int x, int y) const
    {
        return static_cast<size_t>(y - y0_) * static_cast<size_t>(x1_ - x0_) + static_cast<size_t>(x - x0_);
    }
    int width_, height_, x0_, y0_, x1_, y1_;
    std::vector<Pixel> pixels_;
    std::vector<PixelHalves> halves_;
    TileStates tile_states_;
};

} // namespace scree
