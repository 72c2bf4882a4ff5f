#pragma once

#include "render/film/film.h"

#include <vector>

namespace scree {

/// A picture as two estimates that share no sample: their difference is noise, their common part is not.
struct HalfPictures {
    int width = 0, height = 0;
    std::vector<V3d> a, b; ///< mean radiance of each half, rows from the top
    std::vector<V3d> variance; ///< of `whole`, from the scatter of its samples; empty: not known
    double share = 0.5; ///< of the samples: the fraction in a
    bool halved = true; ///< false: a and b are the same picture, and only `variance` tells its noise

    size_t size() const { return a.size(); }
    V3d whole(size_t pixel) const { return share * a[pixel] + (1 - share) * b[pixel]; }
    /// Unbiased estimate of the variance of `whole`, from the difference of the halves if there are two.
    V3d noise(size_t pixel) const
    {
        if (!halved) return variance.empty() ? V3d(0) : variance[pixel];
        const V3d d = a[pixel] - b[pixel];
        return share * (1 - share) * d * d;
    }
    /// Whether anything is known of its noise.
    bool has_noise() const { return halved || !variance.empty(); }
};

/// Makes halves of two or more films of independent seeds and the same size: a of the films at even positions, b of the
/// others.
HalfPictures make_halves(const std::vector<Film>& films);

/// The means over squares of side x side pixels: noise drops by a factor of `side`, errors that neighbours share stay.
HalfPictures reduced(const HalfPictures& picture, int side);

inline double channel_sum(const V3d& v) { return v.x + v.y + v.z; }

/// Mean over all pixels.
V3d mean_radiance(const HalfPictures& picture);

} // namespace scree
