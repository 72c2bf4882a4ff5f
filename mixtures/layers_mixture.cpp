#include "mixtures/layers_mixture.h"

#include <algorithm>
#include <cmath>

namespace scree {

LayersMixture::LayersMixture(const Layers& layers, std::vector<uint32_t> types, const Imath::V3d& origin)
    : direction_(layers.direction.normalized()), origin_(origin), offset_(layers.offset), jitter_(layers.jitter),
      repeat_(layers.repeat), noise_(layers.noise), types_(std::move(types))
{
    for (const double t : layers.thicknesses) {
        if (period_ > 0) ends_.push_back(period_);
        period_ += t;
    }
}

uint32_t LayersMixture::type(uint64_t, const Imath::V3f& position) const
{
    const Imath::V3d p = origin_ + Imath::V3d(position);
    double height = p.dot(direction_) - offset_;
    if (jitter_ != 0) height += jitter_ * noise_(p);
    if (repeat_) height -= period_ * std::floor(height / period_);
    return types_[static_cast<size_t>(std::upper_bound(ends_.begin(), ends_.end(), height) - ends_.begin())];
}

} // namespace scree
