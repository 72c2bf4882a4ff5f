#include "render/film/film.h"

namespace scree {

void Pixel::add(const Color& radiance, const FirstHit& first)
{
    if (samples == 0) {
        type = first.type;
        id = static_cast<uint32_t>(first.id);
    }
    ++samples;
    const Imath::V3d x(radiance.x, radiance.y, radiance.z);
    sum += x;
    sum_of_squares += x * x;
    albedo += first.albedo;
    if (!first.hit) return;
    ++hits;
    normal += first.normal;
    depth += first.depth;
}

Color Pixel::mean() const
{
    if (samples == 0) return Color(0);
    const Imath::V3d m = sum / samples;
    return {static_cast<Real>(m.x), static_cast<Real>(m.y), static_cast<Real>(m.z)};
}

Color Pixel::variance() const
{
    if (samples < 2) return Color(0);
    const double n = samples;
    const Imath::V3d m = sum / n, v = (sum_of_squares / n - m * m) / (n - 1);
    return {static_cast<Real>(std::max(0.0, v.x)), static_cast<Real>(std::max(0.0, v.y)),
            static_cast<Real>(std::max(0.0, v.z))};
}

Film::Film(int width, int height, int x0, int y0, int x1, int y1)
    : width_(width), height_(height), x0_(x0), y0_(y0), x1_(x1), y1_(y1),
      pixels_(static_cast<size_t>(x1 - x0) * static_cast<size_t>(y1 - y0))
{
}

void Film::keep_halves()
{
    halves_.resize(pixels_.size());
    tile_states_.tiles.resize(static_cast<size_t>(tile_columns()) * static_cast<size_t>(tile_rows()));
}

void Film::take_halves()
{
    for (size_t i = 0; i < halves_.size(); ++i) {
        Pixel& pixel = pixels_[i];
        const double n = pixel.samples;
        const V3d mean = halves_[i].mean();
        pixel.sum = n * mean;
        pixel.sum_of_squares = n * ((n - 1) * halves_[i].variance() + mean * mean);
    }
}

} // namespace scree
