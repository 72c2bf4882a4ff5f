#include "render/bench/bench_maps.h"

#include "base/drawing/figure_drawing.h"
#include "base/drawing/picture_file.h"
#include "base/drawing/srgb.h"

namespace scree {

namespace {

std::string base64(const std::string& bytes)
{
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

} // namespace

ScreenPicture screen_picture(const HalfPictures& picture, const std::vector<V3d>& radiance)
{
    return {picture.width, picture.height, radiance};
}

ScreenPicture screen_picture(const HalfPictures& picture)
{
    ScreenPicture screen{picture.width, picture.height, {}};
    for (size_t p = 0; p < picture.size(); ++p) screen.pixels.push_back(picture.whole(p));
    return screen;
}

std::vector<float> shown(const HalfPictures& picture)
{
    std::vector<float> rgb;
    for (size_t p = 0; p < picture.size(); ++p) {
        const V3d c = picture.whole(p);
        for (int k = 0; k < 3; ++k) rgb.push_back(to_srgb(static_cast<float>(c[k])));
    }
    return rgb;
}

std::vector<float> shown_flip(const std::vector<double>& map)
{
    std::vector<float> rgb;
    for (const double v : map) {
        const ScreenColor c = heat_color(v);
        for (const uint8_t k : {c.r, c.g, c.b}) rgb.push_back(static_cast<float>(k) / 255);
    }
    return rgb;
}

std::vector<float> shown_bias(const HalfPictures& picture, const HalfPictures& reference)
{
    if (picture.variance.empty() || reference.variance.empty()) return {};
    std::vector<float> rgb(3 * picture.size());
    const int w = picture.width, h = picture.height;
    for (int y0 = 0; y0 < h; y0 += bias_square) {
        for (int x0 = 0; x0 < w; x0 += bias_square) {
            double difference = 0, variance = 0;
            std::vector<size_t> pixels;
            for (int y = y0; y < std::min(h, y0 + bias_square); ++y)
                for (int x = x0; x < std::min(w, x0 + bias_square); ++x)
                    pixels.push_back(static_cast<size_t>(y) * static_cast<size_t>(w) + static_cast<size_t>(x));
            for (const size_t p : pixels) {
                difference += channel_sum(picture.whole(p) - reference.whole(p));
                // The channels of one sample are correlated: their standard deviations add, not their variances.
                for (const V3d& v : {picture.variance[p], reference.variance[p]}) {
                    const double deviation = std::sqrt(v.x) + std::sqrt(v.y) + std::sqrt(v.z);
                    variance += deviation * deviation;
                }
            }
            const double z = variance > 0 ? std::clamp(difference / std::sqrt(variance) / bias_range, -1.0, 1.0) : 0;
            const double strength = std::abs(z);
            const V3d full = z < 0 ? V3d(0.02, 0.28, 0.62) : V3d(0.72, 0.09, 0.10);
            const V3d color = (1 - strength) * V3d(0.97) + strength * full;
            for (const size_t p : pixels)
                for (size_t k = 0; k < 3; ++k) rgb[3 * p + k] = static_cast<float>(color[static_cast<int>(k)]);
        }
    }
    return rgb;
}

std::string png_address(int width, int height, const std::vector<float>& rgb)
{
    return "data:image/png;base64," + base64(encode_picture("picture.png", width, height, rgb));
}

} // namespace scree
