#pragma once

#include "base/noise.h"
#include "mixtures/mixture.h"

#include <optional>
#include <vector>

namespace scree {

/// Layers stacked along a direction, with plane or wavy faces.
class LayersMixture final : public Mixture {
public:
    struct Layers {
        Imath::V3d direction{0, 0, 1}; ///< from the first layer to the next; any length but 0
        std::vector<double> thicknesses; ///< along the direction, above 0
        double offset = 0; ///< where the first layer begins: distance from 0 along the direction
        bool repeat = true; ///< false: the first and the last layer have no end
        double jitter = 0; ///< amplitude by which noise moves the faces
        NoiseOptions noise; ///< noise of the jitter
    };

    /// types[k] is the type of layer k. origin: the point that positions are relative to.
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
    std::vector<double> ends_; // ends of all layers but the last, from the first layer's beginning
    std::vector<uint32_t> types_;
};

} // namespace scree
