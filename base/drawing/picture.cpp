#include "base/drawing/picture.h"

#include "base/drawing/bitmap_font.h"
#include "base/drawing/picture_file.h"
#include "base/error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace scree {

Picture::Picture(int width, int height, ScreenColor background)
    : width_(width), height_(height), rgb_(3 * static_cast<size_t>(width) * static_cast<size_t>(height))
{
    fill_rectangle(0, 0, width, height, background);
}

ScreenColor Picture::pixel(int x, int y) const
{
    const uint8_t* p = &rgb_[3 * (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x))];
    return {p[0], p[1], p[2]};
}

void Picture::blend(int x, int y, ScreenColor color, double alpha)
{
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
    uint8_t* p = &rgb_[3 * (static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x))];
    const uint8_t target[3] = {color.r, color.g, color.b};
    for (int c = 0; c < 3; ++c) p[c] = static_cast<uint8_t>(std::lround(p[c] + alpha * (target[c] - p[c])));
}

void Picture::fill_rectangle(int x, int y, int width, int height, ScreenColor color)
{
    for (int j = std::max(y, 0); j < std::min(y + height, height_); ++j)
        for (int i = std::max(x, 0); i < std::min(x + width, width_); ++i) blend(i, j, color, 1);
}

void Picture::draw_frame(int x, int y, int width, int height, ScreenColor color)
{
    fill_rectangle(x, y, width, 1, color);
    fill_rectangle(x, y + height - 1, width, 1, color);
    fill_rectangle(x, y, 1, height, color);
    fill_rectangle(x + width - 1, y, 1, height, color);
}

void Picture::draw_disc(double x, double y, double radius, ScreenColor color, const int (&clip)[4])
{
    const auto in = [&](int i, int j) {
        return i >= clip[0] && j >= clip[1] && i < clip[0] + clip[2] && j < clip[1] + clip[3];
    };
    if (radius < 0.7) { // less than a pixel: the opacity is its area
        const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
        if (in(i, j)) blend(i, j, color, std::min(1.0, std::numbers::pi * radius * radius));
        return;
    }
    const auto dark = [](uint8_t c) { return static_cast<uint8_t>(c * 3 / 5); };
    const ScreenColor rim{dark(color.r), dark(color.g), dark(color.b)};
    const double rim_from = radius > 4 ? radius - 1 : 2 * radius;
    for (int j = static_cast<int>(std::floor(y - radius - 1)); j <= static_cast<int>(std::ceil(y + radius + 1)); ++j) {
        for (int i = static_cast<int>(std::floor(x - radius - 1)); i <= static_cast<int>(std::ceil(x + radius + 1));
             ++i) {
            const double distance = std::hypot(i + 0.5 - x, j + 0.5 - y),
                         alpha = std::clamp(radius + 0.5 - distance, 0.0, 1.0);
            if (alpha > 0 && in(i, j)) blend(i, j, distance > rim_from ? rim : color, alpha);
        }
    }
}

void Picture::draw_text(int x, int y, const std::string& text, ScreenColor color, int scale)
{
    for (const char letter : text) {
        const Glyph glyph = glyph_of(letter);
        for (int r = 0; r < Glyph::height; ++r)
            for (int c = 0; c < Glyph::width; ++c)
                if (glyph.rows[static_cast<size_t>(r)] >> (Glyph::width - 1 - c) & 1)
                    fill_rectangle(x + c * scale, y + r * scale, scale, scale, color);
        x += (Glyph::width + 1) * scale;
    }
}

int Picture::text_width(const std::string& text, int scale)
{
    return static_cast<int>(text.size()) * (Glyph::width + 1) * scale;
}
int Picture::text_height(int scale) { return Glyph::height * scale; }

void Picture::write(const std::filesystem::path& path) const
{
    if (!can_write_picture_file(path)) {
        throw InputError(path.string(), "the extension '" + path.extension().string() + "'",
                         "a picture format such as .png");
    }
    std::vector<float> values(rgb_.size());
    std::ranges::transform(rgb_, values.begin(), [](uint8_t c) { return static_cast<float>(c) / 255; });
    write_picture_file(path, width_, height_, values);
}

} // namespace scree
