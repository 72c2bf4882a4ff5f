#include "render/grains/grain_fill.h"

namespace scree {

namespace {

/// Not inlined, because GCC 12 at -O2 drops the conversions of two neighbouring values to float and back.
[[gnu::noinline]] float to_float(double x) { return static_cast<float>(x); }

} // namespace

GrainFill::GrainFill(std::shared_ptr<const ProceduralFill> fill, std::shared_ptr<const Mixture> mixture,
                     const RenderSpace& space)
    : fill_(std::move(fill)), mixture_(std::move(mixture)), origin_(space.origin), factor_(space.length(1))
{
    double least = std::numeric_limits<double>::infinity();
    for (uint64_t row = 0; row < fill_->tile().rows(); ++row) {
        const double r = fill_->radius(row) * factor_;
        least = std::min(least, r);
        largest_radius_ = std::max(largest_radius_, r);
    }
    margin_ = FloatMargin(1, least, largest_radius_);
}

GrainSphere GrainFill::to_render(const ProceduralFill::Sphere& sphere) const
{
    const V3d c = (sphere.centre - origin_) * factor_;
    return {{to_float(c.x), to_float(c.y), to_float(c.z)}, to_float(sphere.radius * factor_)};
}

uint8_t GrainFill::type(uint64_t id, const ProceduralFill::Sphere& sphere) const
{
    return static_cast<uint8_t>(mixture_->type(id, V3f(sphere.centre - fill_->origin())));
}

} // namespace scree
