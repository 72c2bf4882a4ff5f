#include "render/gsdf/error_figure.h"

#include "base/drawing/figure_drawing.h"

#include <fmt/format.h>

namespace scree {

namespace {

using Map = ScatteringMap;

constexpr ScreenColor paper = figure_paper, ink = figure_ink, faint = figure_faint;
constexpr double lowest = 0.01, highest = 10; // relative errors at the ends of the colour scale

/// Positions of the figure's parts, in pixels.
struct Layout {
    int scale, margin, line; // of text
    int left, top, pitch, gap; // of the sheets of discs
    int bar_top, caption_top;

    Layout(int width, int height, int captions)
        : scale(std::max(1, width / 800)), margin(6 * scale), line(Picture::text_height(scale) + 4 * scale)
    {
        const int rows = static_cast<int>(Map::rows), columns = static_cast<int>(Map::turns);
        left = margin + Picture::text_width("0.94 ", scale);
        top = margin + 3 * line + margin;
        gap = 2 * margin;
        const int below = 2 * line + margin + captions * line + margin; // column labels, bar with its labels, caption
        pitch = std::max(
            4, std::min((width - left - margin - gap) / (2 * columns), (height - top - below - 2 * line) / rows));
        bar_top = top + rows * pitch + line + 2 * margin;
        caption_top = bar_top + 2 * line + margin;
    }
    int sheet_left(int sheet) const { return left + sheet * (static_cast<int>(Map::turns) * pitch + gap); }
};

/// Relative error of a cell.
double relative_error(const Map& gsdf, const Map& truth, uint32_t row, uint32_t turn, uint32_t direction)
{
    const size_t i = Map::index(row, turn, direction);
    return std::abs(gsdf.mass[i] - truth.mass[i]) * Map::turns / Map::solid_angle_share(direction);
}

void draw_disc(Picture& picture, const Map& gsdf, const Map& truth, const Layout& layout, int sheet, uint32_t row,
               uint32_t turn)
{
    const double radius = 0.5 * layout.pitch - 1;
    const int x0 = layout.sheet_left(sheet) + static_cast<int>(turn) * layout.pitch;
    const int y0 = layout.top + static_cast<int>(Map::rows - 1 - row) * layout.pitch; // straight on at the top
    const double gamma_o = 2 * pi * turn / Map::turns;
    for (int y = 0; y < layout.pitch; ++y) {
        for (int x = 0; x < layout.pitch; ++x) {
            const double u = (x + 0.5 - 0.5 * layout.pitch) / radius, v = (0.5 * layout.pitch - y - 0.5) / radius;
            const double sine = std::hypot(u, v);
            if (sine >= 1) continue;
            const double beta = sheet == 0 ? std::asin(sine) : pi - std::asin(sine);
            const double turns = (std::atan2(v, u) - gamma_o) / (2 * pi) + 0.5 / Map::azimuths,
                         delta = turns - std::floor(turns);
            const uint32_t of_beta = std::min(Map::polar - 1, static_cast<uint32_t>(beta / pi * Map::polar));
            const uint32_t of_delta = std::min(Map::azimuths - 1, static_cast<uint32_t>(delta * Map::azimuths));
            picture.fill_rectangle(
                x0 + x, y0 + y, 1, 1,
                error_color(relative_error(gsdf, truth, row, turn, of_beta * Map::azimuths + of_delta)));
        }
    }
}

void draw_sheet(Picture& picture, const Map& gsdf, const Map& truth, const Layout& l, int sheet)
{
    const int left = l.sheet_left(sheet), width = static_cast<int>(Map::turns) * l.pitch;
    draw_text_centred(picture, left + width / 2, l.margin + l.line, sheet == 0 ? "front-facing" : "back-facing", ink,
                      l.scale);
    for (uint32_t turn = 0; turn < Map::turns; ++turn) {
        const int middle = left + static_cast<int>(turn) * l.pitch + l.pitch / 2;
        draw_text_centred(picture, middle, l.margin + 2 * l.line, fmt::format("{:.0f}", 360.0 * turn / Map::turns),
                          faint, l.scale);
        for (uint32_t row = 0; row < Map::rows; ++row) draw_disc(picture, gsdf, truth, l, sheet, row, turn);
    }
}

void draw_axes(Picture& picture, const Layout& l)
{
    for (uint32_t row = 0; row < Map::rows; ++row) {
        const int middle = l.top + static_cast<int>(Map::rows - 1 - row) * l.pitch + l.pitch / 2;
        picture.draw_text(l.margin, middle - Picture::text_height(l.scale) / 2,
                          fmt::format("{:.2f}", (row + 0.5) / Map::rows), faint, l.scale);
    }
    const int below = l.top + static_cast<int>(Map::rows) * l.pitch + l.margin;
    picture.draw_text(
        l.left, below,
        "down: cos beta_o   across: gamma_o, degrees   in a disc: sin beta_i from the middle, gamma_i around", faint,
        l.scale);
}

void draw_bar(Picture& picture, const Layout& l)
{
    const std::string title = "|p - p_true| / mean p";
    picture.draw_text(l.left, l.bar_top, title, ink, l.scale);
    const int left = l.left + Picture::text_width(title + "   ", l.scale), right = picture.width() - 8 * l.margin;
    for (int x = left; x < right; ++x) {
        const double at = static_cast<double>(x - left) / (right - 1 - left);
        picture.fill_rectangle(x, l.bar_top, 1, l.line - l.scale, error_color(lowest * std::pow(highest / lowest, at)));
    }
    for (const double tick : {0.01, 0.1, 1.0, 10.0}) {
        const int x =
            left +
            static_cast<int>(std::lround((right - 1 - left) * std::log(tick / lowest) / std::log(highest / lowest)));
        picture.fill_rectangle(x, l.bar_top + l.line - l.scale, 1, 3 * l.scale, ink);
        draw_text_centred(picture, x, l.bar_top + l.line + 3 * l.scale, fmt::format("{:g} %", 100 * tick), ink,
                          l.scale);
    }
}

} // namespace

ScreenColor error_color(double relative)
{
    return heat_color(std::log(std::max(relative, lowest) / lowest) / std::log(highest / lowest));
}

Picture draw_error_figure(const ScatteringMap& gsdf, const ScatteringMap& truth, int width, int height,
                          const std::string& title, const std::vector<std::string>& caption)
{
    const Layout l(width, height, static_cast<int>(caption.size()));
    Picture picture(width, height, paper);
    picture.draw_text(l.margin, l.margin, title, ink, l.scale);
    for (int sheet = 0; sheet < 2; ++sheet) draw_sheet(picture, gsdf, truth, l, sheet);
    draw_axes(picture, l);
    draw_bar(picture, l);
    for (size_t i = 0; i < caption.size(); ++i)
        picture.draw_text(l.margin, l.caption_top + static_cast<int>(i) * l.line, caption[i], ink, l.scale);
    return picture;
}

} // namespace scree
