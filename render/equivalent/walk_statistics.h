#pragma once

#include "base/math.h"
#include "render/equivalent/packing_decay.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace scree {

/// The estimate of a ratio of sums from batches, each with its own sums above and below.
Measured measured_ratio(std::span<const double> above, std::span<const double> below);

/// One lossless walk from scattering to scattering.
struct WalkTrail {
    std::vector<V3d> position, direction; ///< where flight i starts and where to; one more of them than scatterings
    std::vector<V3d> kept; ///< per channel what scattering i keeps, that at the end of flight i
    std::vector<double> flight; ///< length of flight i

    uint64_t scatterings() const { return kept.size(); }
    void clear();
};

/// How light decays deep in the packing, in one channel.
struct PackingDecay {
    double albedo = 1; ///< mean weight of a scattering
    Measured kappa; ///< per unit of length; 0 where nothing is lost
    uint32_t steps = 0; ///< scatterings of the ways that it is from
    Measured check; ///< from ways of half as many
};

/// Sums over the walks of one batch, and their places; batches may be filled by different threads.
class WalkBatch {
public:
    /// memory: scatterings after which what a step still says of those to come is said by the direction alone.
    explicit WalkBatch(uint32_t memory) : memory_(memory) {}
    void add(const WalkTrail& trail);

private:
    friend class WalkStatistics;
    struct Node {
        V3f position, direction; // from the walk's start
        std::array<float, 3> kept; // logarithm of, up to here
    };
    /// Over windows of `memory` scatterings after a step Y with direction w.
    struct Windows {
        double count = 0;
        double transport = 0, direction = 0; // w . way of the window from w on, w . w at its end
        double own = 0, later = 0, last = 0; // Y . Y / 2, Y . way of the window after Y, Y . w at its end
    };
    static void add_window(Windows& windows, const WalkTrail& trail, size_t i, size_t memory);

    uint32_t memory_;
    Windows windows_, half_; // half_: of half the memory
    double scatterings_ = 0, flight_ = 0, cosine_ = 0;
    V3d kept_{0};
    std::vector<Node> nodes_;
    std::vector<size_t> walks_; // where walks begin in nodes_
};

/// What the batches say together.
///
/// Of a stationary walk every scattering is a fair start. With steps Y_i, D = <Y_i^2> / 2 + sum of <Y_i . Y_(i+k)> over
/// k >= 1 and l* = <w_i . (Y_i + Y_(i+1) + ...)>. The sums are taken up to `memory`; beyond, a walk goes on along its
/// direction w by l* w, as any does: l* = <w_0 . x_m> / (1 - <w_0 . w_m>), and with it the rest of D.
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
    /// By ways of so many scatterings that twice as many would say the same, or too little.
    PackingDecay decay(int channel) const;
    Measured decay_of_steps(int channel, uint32_t steps) const;

private:
    using Windows = WalkBatch::Windows;
    Measured over_scatterings(double WalkBatch::*sum) const;
    Measured diffusivity(Windows WalkBatch::*windows) const;
    Measured transport_length(Windows WalkBatch::*windows) const;

    std::span<const WalkBatch> batches_;
};

/// How many scatterings it takes until light of mean cosine g has forgotten its direction to a hundredth; at least 12,
/// as long as opaque grains find the ways free that they were met by (measured: memory 8 leaves 1 % of l* at pack rate
/// 0.6, 16 half a per cent).
uint32_t walk_memory(double g);

} // namespace scree
