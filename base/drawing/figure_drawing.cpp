#include "base/drawing/figure_drawing.h"

#include "base/error.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace scree {

ScreenColor heat_color(double at)
{
    constexpr double anchors[][3] = {{8, 6, 20},    {70, 15, 105},  {165, 40, 95},
                                     {230, 95, 45}, {250, 180, 40}, {252, 250, 200}};
    constexpr int last = std::size(anchors) - 1;
    at = std::clamp(at, 0.0, 1.0) * last;
    const int low = std::min(last - 1, static_cast<int>(at));
    const auto channel = [&](int c) {
        return static_cast<uint8_t>(
            std::lround(anchors[low][c] + (at - low) * (anchors[low + 1][c] - anchors[low][c])));
    };
    return {channel(0), channel(1), channel(2)};
}

void draw_text_centred(Picture& picture, int x, int y, const std::string& text, ScreenColor color, int scale)
{
    picture.draw_text(x - Picture::text_width(text, scale) / 2, y, text, color, scale);
}

FigureSize read_figure_size(const std::string& text)
{
    constexpr int most = 16384;
    const size_t x = text.find('x');
    const auto width = to_int64(text.substr(0, x));
    const auto height = x == std::string::npos ? std::nullopt : to_int64(text.substr(x + 1));
    if (!width || !height || *width < least_figure_size.width || *height < least_figure_size.height || *width > most ||
        *height > most) {
        throw InputError("--size", in_quotes(text),
                         fmt::format("WIDTHxHEIGHT in pixels, {}x{} to {}x{}", least_figure_size.width,
                                     least_figure_size.height, most, most));
    }
    return {static_cast<int>(*width), static_cast<int>(*height)};
}

} // namespace scree
