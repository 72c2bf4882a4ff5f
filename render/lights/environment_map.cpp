#include "render/lights/environment_map.h"

namespace scree {

namespace {

/// The shortest rotation that takes +z to `up` (rows are images of the axes).
Imath::M33d rotation_to(const V3d& up)
{
    const V3d z(0, 0, 1);
    const Imath::Quatd q = [&] {
        if (up.z <= -1) return Imath::Quatd(0, 1, 0, 0);
        Imath::Quatd half(1 + up.z, z.cross(up));
        return half.normalize();
    }();
    const Imath::M33d m(q.rotateVector(V3d(1, 0, 0)).x, q.rotateVector(V3d(1, 0, 0)).y, q.rotateVector(V3d(1, 0, 0)).z,
                        q.rotateVector(V3d(0, 1, 0)).x, q.rotateVector(V3d(0, 1, 0)).y, q.rotateVector(V3d(0, 1, 0)).z,
                        up.x, up.y, up.z);
    return m;
}

} // namespace

EnvironmentMap::EnvironmentMap(std::vector<Color> texels, size_t width, size_t height, const V3d& up,
                               const Color& scale)
    : texels_(std::move(texels)), width_(width), height_(height), to_world_(rotation_to(up.normalized()))
{
    to_map_ = to_world_.transposed();
    for (Color& texel : texels_) texel *= scale;
    // The density of a cell is the mean of its 3x3 block times the sine of the polar angle. Interpolation carries
    // radiance into neighbouring cells, so the block makes the density positive wherever the radiance is; the sine is
    // for the area that a row covers.
    std::vector<float> weight(width * height);
    for (size_t y = 0; y < height; ++y) {
        const double sine = std::sin(pi * (static_cast<double>(y) + 0.5) / static_cast<double>(height));
        for (size_t x = 0; x < width; ++x) {
            double sum = 0;
            for (size_t dy = 0; dy < 3; ++dy) {
                const size_t yy = std::clamp<size_t>(y + dy, 1, height) - 1;
                for (size_t dx = 0; dx < 3; ++dx) sum += luminance(texel((x + dx + width - 1) % width, yy));
            }
            weight[y * width + x] = static_cast<float>(sum * sine);
        }
    }
    distribution_ = Distribution2D(weight, width, height);
}

V2d EnvironmentMap::to_square(const V3d& direction) const
{
    const V3d d = direction * to_map_;
    const double u = 0.5 - std::atan2(d.y, d.x) / (2 * pi);
    return {u, std::acos(std::clamp(d.z, -1.0, 1.0)) / pi};
}

Color EnvironmentMap::radiance(const V3d& direction) const
{
    const V2d p = to_square(direction);
    const double x = p.x * static_cast<double>(width_) - 0.5, y = p.y * static_cast<double>(height_) - 0.5;
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    const auto wrap = [&](double column) {
        const auto w = static_cast<int64_t>(width_);
        return static_cast<size_t>(((static_cast<int64_t>(column) % w) + w) % w);
    };
    const auto clamp = [&](double row) {
        return static_cast<size_t>(std::clamp(row, 0.0, static_cast<double>(height_ - 1)));
    };
    const size_t x0 = wrap(std::floor(x)), x1 = wrap(std::floor(x) + 1);
    const size_t y0 = clamp(std::floor(y)), y1 = clamp(std::floor(y) + 1);
    const auto row = [&](size_t yy) {
        return texel(x0, yy) * static_cast<Real>(1 - fx) + texel(x1, yy) * static_cast<Real>(fx);
    };
    return row(y0) * static_cast<Real>(1 - fy) + row(y1) * static_cast<Real>(fy);
}

V3d EnvironmentMap::sample(double u1, double u2) const
{
    const V2d p = distribution_.sample(u1, u2);
    const double phi = 2 * pi * (0.5 - p.x), theta = pi * p.y, sine = std::sin(theta);
    return V3d(sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)) * to_world_;
}

double EnvironmentMap::pdf(const V3d& direction) const
{
    const V2d p = to_square(direction);
    const double sine = std::sin(pi * p.y);
    return sine > 0 ? distribution_.pdf(p) / (2 * pi * pi * sine) : 0;
}

Color EnvironmentMap::mean() const
{
    Color sum(0);
    double total = 0;
    for (size_t y = 0; y < height_; ++y) {
        const double sine = std::sin(pi * (static_cast<double>(y) + 0.5) / static_cast<double>(height_));
        Color row(0);
        for (size_t x = 0; x < width_; ++x) row += texel(x, y);
        sum += row * static_cast<Real>(sine);
        total += sine * static_cast<double>(width_);
    }
    return sum * static_cast<Real>(1 / total);
}

} // namespace scree
