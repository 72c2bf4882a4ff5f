#pragma once

#include "base/math.h"

namespace scree {

/// Squared errors of pixels relative to what they should be, so that dark and bright parts of a picture count alike.
///
/// Pixels much darker than the picture count as if they were a tenth as bright as its mean, or noise in the black would
/// be all. Both are free of the picture's unit. Müller et al. 2016 call the mean of it over a picture MRSE.
class RelativeError {
public:
    /// mean: of the picture.
    explicit RelativeError(const V3d& mean) : floor_(0.01 * mean.dot(mean)) {}

    /// squared: of the error, summed over the channels; 0 where the whole picture is black.
    double of(double squared, const V3d& truth) const
    {
        const double scale = truth.dot(truth) + floor_;
        return scale > 0 ? squared / scale : 0;
    }

private:
    double floor_;
};

} // namespace scree
