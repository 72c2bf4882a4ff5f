#pragma once

#include "base/noise.h"
#include "mixtures/mixture.h"

#include <vector>

namespace scree {

/// The type follows from the value of fractal noise at the sphere's centre.
class PerlinMixture final : public Mixture {
public:
    /// types[k] is for noise below thresholds[k] (ascending, one fewer than types) and not below thresholds[k - 1].
    /// origin: the point that positions are relative to.
    PerlinMixture(const NoiseOptions& noise, std::vector<uint32_t> types, std::vector<double> thresholds,
                  const Imath::V3d& origin)
        : noise_(noise), origin_(origin), types_(std::move(types)), thresholds_(std::move(thresholds))
    {
    }

    uint32_t type(uint64_t, const Imath::V3f& position) const override
    {
        const double value = noise_(origin_ + Imath::V3d(position));
        size_t k = 0;
        while (k < thresholds_.size() && value >= thresholds_[k]) ++k;
        return types_[k];
    }
    std::optional<std::set<uint32_t>> possible_types() const override
    {
        return std::set<uint32_t>(types_.begin(), types_.end());
    }

private:
    FractalNoise noise_;
    Imath::V3d origin_;
    std::vector<uint32_t> types_;
    std::vector<double> thresholds_;
};

} // namespace scree
