#pragma once

#include "base/noise.h"
#include "mixtures/mixture.h"

#include <optional>
#include <vector>

namespace scree {

/// Layers across a direction, one after the other, their faces plane or wavy.
class LayersMixture final : public Mixture {
public:
    struct Layers {
        Imath::V3d direction{0, 0, 1}; ///< of any length but 0; from the first layer to the next
        std::vector<double> thicknesses; ///< along the direction, above 0
        double offset = 0; ///< where the first layer begins, along the direction from 0
        bool repeat = true; ///< else the first and the last one have no end
        double jitter = 0; ///< amplitude by which noise moves the faces
        NoiseOptions noise; ///< of the jitter
    };

    /// types[k] is the type of layer k. origin: the place that positions are relative to.
    LayersMixture(const Layers& layers, std::vector<uint32_t> types, const Imath::V3d& origin);

    uint32_t type(uint64_t index, const Imath::V3f& position) const override;
    std::optional<std::set<uint32_t>> possible_types() const override
    {
        return std::set<uint32_t>(types_.begin(), types_.end());
    }

private:
    Imath::V3d direction_, origin_;
    double offset_, jitter_, period_ = 0;
    bool repeat_;
    FractalNoise noise_;
    std::vector<double> ends_; // of all layers but the last, from 0
    std::vector<uint32_t> types_;
};

} // namespace scree
