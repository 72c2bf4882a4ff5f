#pragma once

#include "render/gsdf/gsdf.h"
#include "render/media/cosine_table.h"

namespace scree {

/// Moments of the scattering by one grain, as means over impact points and rotations; lengths in radii of the bounding
/// sphere.
///
/// Light comes from all directions, as in a packing: uniform in q = sin^2 beta_o (Müller et al. 2016). `delta` is the
/// vector from the entry into the bounding sphere to the exit from it. For a reciprocal material a path and its reverse
/// are equally likely, so that along_in = along_out except for the noise of the records.
struct GrainMoments {
    double alpha0 = 0; ///< probability of passing straight through: mean of the paper's alpha0(q)
    double pass_chord = 0, pass_chord2 = 0; ///< mean chord of the straight passes, and its mean square
    double g = 0; ///< mean cosine of scattering, without losses
    double along_in = 0, along_out = 0; ///< means of delta . w_in and delta . w_out
    double delta2 = 0; ///< mean of delta^2
    CosineTable phase;
};

/// The moments of the scattering that an integrator samples: strata interpolated in q, cells by their mass, records
/// within a cell uniformly.
GrainMoments grain_moments(const Gsdf& gsdf);

/// The part of the light that a grain's scattering keeps: means over scattered light, per channel.
struct GrainAlbedo {
    V3d weight{1}; ///< mean of the weight
    /// mean of weight times cosine; divided by `weight` it is the asymmetry of the remaining light
    V3d weighted_cosine{0};
};

/// The albedo at one radius; material and radius as for Gsdf::weight.
GrainAlbedo grain_albedo(const Gsdf& gsdf, const Material& material, double radius);

/// The albedo at any radius, from one pass over the records: a histogram of their weights before absorption over their
/// path length in the grain. Its bins are a thousandth of the longest path wide, and a weight is split linearly between
/// two bins: the error is at most (sigma_a r width)^2 / 8.
class GrainAlbedoByRadius {
public:
    GrainAlbedoByRadius(const Gsdf& gsdf, const Material& material);
    GrainAlbedo at(double radius) const;

private:
    struct Bin {
        V3d weight{0}, weighted_cosine{0};
    };
    V3d absorption_, lost_{0}; ///< lost_: lost at the surface
    double width_ = 0; ///< width of a bin, in radii
    std::vector<Bin> bins_;
};

} // namespace scree
