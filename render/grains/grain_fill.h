#pragma once

#include "base/render_space.h"
#include "mixtures/mixture.h"
#include "packing/fill/procedural_fill.h"
#include "render/grains/grain_store.h"

#include <memory>

namespace scree {

/// The grains of a procedural fill in render coordinates: computed from their ids, not stored as in a GrainStore.
///
/// Positions and radii are rounded to float, as in a GrainStore of the same spheres, so that both give the same
/// picture.
class GrainFill {
public:
    GrainFill(std::shared_ptr<const ProceduralFill> fill, std::shared_ptr<const Mixture> mixture,
              const RenderSpace& space);

    const ProceduralFill& fill() const { return *fill_; }

    GrainSphere sphere(uint64_t id) const { return to_render(fill_->sphere(id)); }
    GrainSphere to_render(const ProceduralFill::Sphere& sphere) const;
    /// The grain type of a grain of the fill.
    uint8_t type(uint64_t id) const { return type(id, fill_->sphere(id)); }
    uint8_t type(uint64_t id, const ProceduralFill::Sphere& sphere) const;

    const FloatMargin& margin() const { return margin_; }
    double largest_radius() const { return largest_radius_; }

private:
    std::shared_ptr<const ProceduralFill> fill_;
    std::shared_ptr<const Mixture> mixture_;
    Imath::V3d origin_; // of render coordinates
    double factor_ = 1; // render units per scene unit, a power of two
    FloatMargin margin_;
    double largest_radius_ = 0;
};

} // namespace scree
