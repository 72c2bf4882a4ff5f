#pragma once

#include "base/math.h"
#include "render/equivalent/packing_decay.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// The estimate of a ratio of sums, from the numerators (`above`) and denominators (`below`) of batches.
Measured measured_ratio(std::span<const double> above, std::span<const double> below);

/// One lossless walk from scattering to scattering.
struct WalkTrail {
    std::vector<V3d> position, direction; ///< start and direction of flight i; one more than scatterings
    std::vector<V3d> kept; ///< weight of scattering i, which is at the end of flight i, per channel
    std::vector<double> flight; ///< length of flight i

    uint64_t scatterings() const { return kept.size(); }
    void clear();
};

/// The decay of light deep in the packing, in one channel.
struct PackingDecay {
    double albedo = 1; ///< mean weight of a scattering
    Measured kappa; ///< per unit of length; 0 where nothing is lost
    uint32_t steps = 0; ///< scatterings of the paths from which kappa is computed
    Measured check; ///< kappa from paths with half as many scatterings
};

/// Sums over the walks of one batch, and their positions; different threads may fill different batches.
class WalkBatch {
public:
    /// memory: number of scatterings after which later steps depend on a step only through the current direction.
    explicit WalkBatch(uint32_t memory) : memory_(memory) {}
    void add(const WalkTrail& trail);

private:
    friend class WalkStatistics;
    struct Node {
        V3f position, direction; // position relative to the walk's start
        std::array<float, 3> kept; // logarithm of the weight up to here
    };
    /// Sums over windows of `memory` scatterings after a step Y with direction w.
    struct Windows {
        double count = 0;
        // w . displacement over the window that starts with w; w . direction at its end
        double transport = 0, direction = 0;
        // Y . Y / 2; Y . displacement over the window after Y; Y . direction at its end
        double own = 0, later = 0, last = 0;
    };
    static void add_window(Windows& windows, const WalkTrail& trail, size_t i, size_t memory);

    uint32_t memory_;
    Windows windows_, half_; // half_: with half the memory
    double scatterings_ = 0, flight_ = 0, cosine_ = 0;
    V3d kept_{0};
    std::vector<Node> nodes_;
    std::vector<size_t> walks_; // index in nodes_ where each walk begins
};

/// The statistics of all batches together.
///
/// In a stationary walk every scattering is an unbiased start. With steps Y_i, D = <Y_i^2> / 2 + sum of <Y_i . Y_(i+k)>
/// over k >= 1 and l* = <w_i . (Y_i + Y_(i+1) + ...)>. The sums are taken up to `memory`. Beyond it, the mean
/// displacement of a walk with direction w is l* w, as for any walk: so l* = <w_0 . x_m> / (1 - <w_0 . w_m>), and l*
/// gives the rest of D.
class WalkStatistics {
public:
    explicit WalkStatistics(std::span<const WalkBatch> batches) : batches_(batches) {}

    uint64_t scatterings() const;
    Measured flight() const { return over_scatterings(&WalkBatch::flight_); }
    Measured cosine() const { return over_scatterings(&WalkBatch::cosine_); }
    Measured diffusivity() const { return diffusivity(&WalkBatch::windows_); }
    Measured transport_length() const { return transport_length(&WalkBatch::windows_); }
    Measured half_diffusivity() const { return diffusivity(&WalkBatch::half_); }
    Measured half_transport_length() const { return transport_length(&WalkBatch::half_); }
    V3d albedo() const;
    /// From paths with so many scatterings that twice as many would give the same result within its error, or a result
    /// that is too uncertain.
    PackingDecay decay(int channel) const;
    Measured decay_of_steps(int channel, uint32_t steps) const;

private:
    using Windows = WalkBatch::Windows;
    Measured over_scatterings(double WalkBatch::*sum) const;
    Measured diffusivity(Windows WalkBatch::*windows) const;
    Measured transport_length(Windows WalkBatch::*windows) const;

    std::span<const WalkBatch> batches_;
};

/// The number of scatterings after which light with mean cosine g has forgotten its direction to 1 %; at least 12,
/// because light that leaves an opaque grain finds the path free by which it came (measured at pack rate 0.6: the error
/// of l* is 1 % with memory 8, 0.5 % with 16).
uint32_t walk_memory(double g);

} // namespace scree
