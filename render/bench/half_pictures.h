#pragma once

#include "render/film/film.h"

#include <vector>

namespace scree {

/// A picture as two estimates that share no sample: what differs between them is noise, what they have in common is
/// not.
struct HalfPictures {
    int width = 0, height = 0;
    std::vector<V3d> a, b; ///< mean radiance of each half, rows from the top
    std::vector<V3d> variance; ///< of the whole, by the scatter of its samples; empty: not known
    double share = 0.5; ///< of the samples that are in a
    bool halved = true; ///< false: a and b are the same picture, of which only `variance` knows the noise

    size_t size() const { return a.size(); }
    V3d whole(size_t pixel) const { return share * a[pixel] + (1 - share) * b[pixel]; }
    /// Unbiased estimate of the variance of `whole`, from the difference of the halves where there are any.
    V3d noise(size_t pixel) const
    {
        if (!halved) return variance.empty() ? V3d(0) : variance[pixel];
        const V3d d = a[pixel] - b[pixel];
        return share * (1 - share) * d * d;
    }
    /// Whether anything is known of its noise.
    bool has_noise() const { return halved || !variance.empty(); }
};

/// Films of independent seeds, of one size: those of even places are the one half, the others the other. At least two.
HalfPictures make_halves(const std::vector<Film>& films);

/// The means of squares of `side` pixels: where noise goes down by the side, what neighbours have in common stays.
HalfPictures reduced(const HalfPictures& picture, int side);

inline double channel_sum(const V3d& v) { return v.x + v.y + v.z; }

/// Mean over all pixels.
V3d mean_radiance(const HalfPictures& picture);

} // namespace scree
