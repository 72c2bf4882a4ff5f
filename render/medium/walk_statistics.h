#pragma once

#include "render/math.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// A number that was measured, with its standard error.
struct Measured {
    double value = 0, error = 0;
};

/// The estimate of a ratio of sums from batches, each with its own sums above and below.
Measured measured_ratio(std::span<const double> above, std::span<const double> below);

/// One lossless walk from scattering to scattering.
struct WalkTrail {
    std::vector<V3d> position, direction; ///< where flight i starts and where to; one more of them than scatterings
    std::vector<V3d> kept;                ///< per channel what scattering i keeps, that at the end of flight i
    std::vector<double> flight;           ///< length of flight i

    uint64_t scatterings() const { return kept.size(); }
    void clear();
};

/// How light decays deep in the packing, in one channel.
struct PackingDecay {
    double albedo = 1;       ///< mean weight of a scattering
    uint32_t steps = 0;      ///< n: kappa is from n and 2 n scatterings
    Measured kappa;          ///< per unit of length; 0 for albedo 1
    Measured check;          ///< the same from n / 2 and n
};

/// Sums over the walks of one batch; batches may be filled by different threads.
///
/// Of a stationary walk every scattering is a fair start. With steps Y_i, D = <Y_i^2> / 2 + sum of <Y_i . Y_(i+k)> for k up to
/// `memory`, and l* = <w_i . (Y_i + ... + Y_(i+memory))>.
class WalkBatch {
public:
    /// steps: of `decay`, per channel; 0: none wanted.
    WalkBatch(uint32_t memory, const std::array<uint32_t, 3>& steps) : memory_(memory), steps_(steps) {}
    void add(const WalkTrail& trail);

private:
    friend class WalkStatistics;
    /// A way of n scatterings, and its first half and first quarter: how far it led and what it kept.
    struct Way {
        std::array<float, 3> length, weight; // of 2 n, n and n / 2 scatterings
    };
    uint32_t memory_;
    std::array<uint32_t, 3> steps_;
    double windows_ = 0, diffusivity_ = 0, transport_ = 0, half_diffusivity_ = 0, half_transport_ = 0;
    double scatterings_ = 0, flight_ = 0, cosine_ = 0;
    V3d kept_{0};
    std::array<std::vector<Way>, 3> ways_;
};

/// What the batches say together.
class WalkStatistics {
public:
    explicit WalkStatistics(std::span<const WalkBatch> batches) : batches_(batches) {}

    uint64_t scatterings() const;
    Measured flight() const { return over_scatterings(&WalkBatch::flight_); }
    Measured cosine() const { return over_scatterings(&WalkBatch::cosine_); }
    Measured diffusivity() const { return over_windows(&WalkBatch::diffusivity_); }
    Measured transport_length() const { return over_windows(&WalkBatch::transport_); }
    Measured half_diffusivity() const { return over_windows(&WalkBatch::half_diffusivity_); }
    Measured half_transport_length() const { return over_windows(&WalkBatch::half_transport_); }
    V3d albedo() const;
    /// exp(kappa z) averaged over directions is sinh(kappa r) / (kappa r); kappa is where its mean over ways of n scatterings, weighted
    /// by what they keep, is the same for n and 2 n.
    PackingDecay decay(int channel) const;

private:
    Measured over_scatterings(double WalkBatch::*sum) const { return over(sum, &WalkBatch::scatterings_); }
    Measured over_windows(double WalkBatch::*sum) const { return over(sum, &WalkBatch::windows_); }
    Measured over(double WalkBatch::*sum, double WalkBatch::*count) const;
    /// kappa from ways[far] and ways[near].
    Measured decay_between(int channel, size_t far, size_t near) const;

    std::span<const WalkBatch> batches_;
};

/// How many scatterings it takes until light of mean cosine g has forgotten its direction to a thousandth; 16 to 256.
uint32_t walk_memory(double g);
/// The n of `PackingDecay` for an albedo: light is then dimmed to about 1 / e.
uint32_t decay_steps(double albedo, uint32_t memory);

} // namespace scree
