#pragma once

#include "base/math.h"

namespace scree {

/// Squared errors of pixels relative to their true values, so that dark and bright parts of a picture count alike.
///
/// Pixels much darker than the picture's mean count as if they had a tenth of the mean's brightness: otherwise noise in
/// black parts would dominate. The result does not depend on the picture's unit. Müller et al. 2016 call its mean over
/// a picture MRSE.
class RelativeError {
public:
    /// mean: of the picture.
    explicit RelativeError(const V3d& mean) : floor_(0.01 * mean.dot(mean)) {}

    /// The relative squared error, 0 if the whole picture is black. squared: the squared error, summed over channels.
    double of(double squared, const V3d& truth) const
    {
        const double scale = truth.dot(truth) + floor_;
        return scale > 0 ? squared / scale : 0;
    }

private:
    double floor_;
};

} // namespace scree
