#pragma once

#include "base/distribution2d.h"
#include "base/math.h"

#include <vector>

namespace scree {

/// A latitude-longitude picture of the far surroundings, interpolated bilinearly and importance sampled.
///
/// The top row looks along `up`. For up = +z the middle of the picture looks along +x and its left quarter along +y
/// (as in Blender); for another `up` the picture is turned by the shortest rotation from +z.
class EnvironmentMap {
public:
    /// texels: height rows of width radiances, top row first; all >= 0 and finite.
    EnvironmentMap(std::vector<Color> texels, size_t width, size_t height, const V3d& up, const Color& scale);

    Color radiance(const V3d& direction) const;
    /// Unit direction with density `pdf(direction)` per solid angle.
    V3d sample(double u1, double u2) const;
    double pdf(const V3d& direction) const;
    /// Radiances, scaled, top row first.
    const std::vector<Color>& texels() const { return texels_; }
    /// Mean radiance over the sphere.
    Color mean() const;

private:
    V2d to_square(const V3d& direction) const;
    const Color& texel(size_t x, size_t y) const { return texels_[y * width_ + x]; }

    std::vector<Color> texels_;
    size_t width_, height_;
    Imath::M33d to_map_, to_world_;
    Distribution2D distribution_;
};

} // namespace scree
