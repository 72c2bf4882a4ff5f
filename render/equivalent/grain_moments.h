#pragma once

#include "render/gsdf/gsdf.h"
#include "render/media/cosine_table.h"

namespace scree {

/// What one encounter with a grain does to light in the mean over impacts and rotations, in radii of the bounding
/// sphere.
///
/// Light comes as in a packing, from everywhere: uniform in q. `delta` is the way from the entry into the bounding
/// sphere to the exit from it. What a grain of a reciprocal material does backwards is as likely, so that along_in =
/// along_out but for the noise of the records.
struct GrainMoments {
    double alpha0 = 0; ///< probability of passing straight through
    double pass_chord = 0, pass_chord2 = 0; ///< mean chord of the passes, and mean square
    double g = 0; ///< mean cosine of the scattered, lossless
    double along_in = 0, along_out = 0; ///< means of delta . w_in and delta . w_out
    double delta2 = 0; ///< mean of delta^2
    CosineTable phase;
};

/// The moments of scattering as an integrator samples it: strata interpolated in q, cells by their mass, records within
/// them.
GrainMoments grain_moments(const Gsdf& gsdf);

/// What a grain's scattering keeps of light: means over scattered light, per channel.
struct GrainAlbedo {
    V3d weight{1}; ///< mean of the weight
    V3d weighted_cosine{0}; ///< mean of weight times cosine; over `weight` it is the asymmetry of what is kept
};

/// material and radius as for Gsdf::weight.
GrainAlbedo grain_albedo(const Gsdf& gsdf, const Material& material, double radius);

/// The same of any radius, from one pass over the records: what they weigh before absorption, by how far they went in
/// the grain. Lengths are kept by the thousandth of the longest, between which weights are split by distance: off by
/// (sigma_a r width)^2 / 8 at most.
class GrainAlbedoByRadius {
public:
    GrainAlbedoByRadius(const Gsdf& gsdf, const Material& material);
    GrainAlbedo at(double radius) const;

private:
    struct Bin {
        V3d weight{0}, weighted_cosine{0};
    };
    V3d absorption_, lost_{0}; ///< lost_: at the surface
    double width_ = 0; ///< of a bin, in radii
    std::vector<Bin> bins_;
};

} // namespace scree
