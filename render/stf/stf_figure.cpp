#include "render/stf/stf_figure.h"

#include "base/drawing/figure_drawing.h"

#include <fmt/format.h>

#include <functional>

namespace scree {

namespace {

constexpr int rows = static_cast<int>(ShellMaps::rows);
const std::vector<std::string> caption{"down: theta_t, degrees   across: radius of the shell, mean free paths",
                                       "in a disc: sin beta from the middle, gamma around; right is growing theta_t",
                                       "below a disc: its peak, over a cosine hemisphere's",
                                       "cos: mean cosine to the normal; L1: of cos^2, from a cosine hemisphere's",
                                       "large shells shine as a half-space does from deep within (Milne): cos 0.7104"};

/// Positions of the figure's parts, in pixels.
struct Layout {
    int scale, margin, line;
    int left, top, pitch, gap; // of the discs
    int caption_top;

    Layout(int width, int height, int columns)
        : scale(std::max(1, width / 800)), margin(6 * scale), line(Picture::text_height(scale) + 4 * scale)
    {
        left = margin + Picture::text_width("109-132 ", scale);
        top = margin + 2 * line + margin;
        gap = 3 * margin;
        const int below = 2 * line + 2 * margin + static_cast<int>(caption.size()) * line + margin;
        pitch =
            std::max(4, std::min((width - left - margin - gap) / (columns + 1), (height - top - below) / rows - line));
        caption_top = top + rows * (pitch + line) + 2 * line + 2 * margin;
    }
    int row_top(int row) const { return top + row * (pitch + line); }
    int column_left(int column) const { return left + column * pitch; }
};

/// density: per solid angle, 1 at its peak; x and y: components of the direction along growing theta_t and across.
void draw_disc(Picture& picture, int left, int top, int pitch, const std::function<double(double x, double y)>& density)
{
    const double radius = 0.5 * pitch - 1;
    for (int j = 0; j < pitch; ++j) {
        for (int i = 0; i < pitch; ++i) {
            const double x = (i + 0.5 - 0.5 * pitch) / radius, y = (0.5 * pitch - j - 0.5) / radius;
            if (x * x + y * y < 1) picture.fill_rectangle(left + i, top + j, 1, 1, heat_color(density(x, y)));
        }
    }
}

void draw_shell(Picture& picture, const ShellMaps& shell, int column, const Layout& l)
{
    const int left = l.column_left(column), middle = left + l.pitch / 2;
    draw_text_centred(picture, middle, l.margin + l.line, fmt::format("{:.4g}", shell.radius), figure_ink, l.scale);
    for (int row = 0; row < rows; ++row) {
        const DirectionMap& map = shell.by_theta[static_cast<size_t>(row)];
        const double peak = map.peak();
        if (!(peak > 0)) continue;
        draw_disc(picture, left, l.row_top(row), l.pitch,
                  [&](double x, double y) { return map.density_at(x, y) * safe_sqrt(1 - x * x - y * y) * pi / peak; });
        draw_text_centred(picture, middle, l.row_top(row) + l.pitch + l.scale, fmt::format("{:.2f}", peak),
                          figure_faint, l.scale);
    }
    const int below = l.row_top(rows) + l.margin;
    draw_text_centred(picture, middle, below, fmt::format("{:.4f}", shell.mean_cosine), figure_ink, l.scale);
    draw_text_centred(picture, middle, below + l.line, fmt::format("{:.2f} %", 100 * shell.distance.distance()),
                      figure_ink, l.scale);
}

void draw_rows(Picture& picture, const Layout& l)
{
    const auto degrees = [](int edge) { return 180 / pi * std::acos(std::clamp(1 - 2.0 * edge / rows, -1.0, 1.0)); };
    for (int row = 0; row < rows; ++row) {
        const int y = l.row_top(row) + (l.pitch - Picture::text_height(l.scale)) / 2;
        picture.draw_text(l.margin, y, fmt::format("{:.0f}-{:.0f}", degrees(row), degrees(row + 1)), figure_faint,
                          l.scale);
    }
    const int below = l.row_top(rows) + l.margin;
    picture.draw_text(l.margin, below, "cos", figure_faint, l.scale);
    picture.draw_text(l.margin, below + l.line, "L1", figure_faint, l.scale);
}

/// The cosine hemisphere, and the colour scale.
void draw_reference(Picture& picture, int columns, const Layout& l)
{
    const int left = l.column_left(columns) + l.gap, middle = left + l.pitch / 2;
    draw_text_centred(picture, middle, l.margin + l.line, "cosine", figure_ink, l.scale);
    draw_disc(picture, left, l.row_top(0), l.pitch, [](double x, double y) { return safe_sqrt(1 - x * x - y * y); });
    draw_text_centred(picture, middle, l.row_top(0) + l.pitch + l.scale, "1.00", figure_faint, l.scale);

    const int top = l.row_top(1) + l.line + l.margin, bottom = l.row_top(rows) - 2 * l.line,
              width = std::max(2, l.pitch / 5);
    draw_text_centred(picture, middle, top - l.line, "peak", figure_faint, l.scale);
    for (int y = top; y < bottom; ++y)
        picture.fill_rectangle(middle - width / 2, y, width, 1,
                               heat_color(static_cast<double>(bottom - 1 - y) / std::max(1, bottom - 1 - top)));
    draw_text_centred(picture, middle, bottom + 2 * l.scale, "0", figure_faint, l.scale);

    const int below = l.row_top(rows) + l.margin;
    draw_text_centred(picture, middle, below, "0.6667", figure_ink, l.scale);
    draw_text_centred(picture, middle, below + l.line, "0 %", figure_ink, l.scale);
}

} // namespace

Picture draw_stf_figure(std::span<const ShellMaps> shells, int width, int height, const std::string& title)
{
    const int columns = static_cast<int>(shells.size());
    const Layout l(width, height, columns);
    Picture picture(width, height, figure_paper);
    picture.draw_text(l.margin, l.margin, title, figure_ink, l.scale);
    draw_rows(picture, l);
    for (int column = 0; column < columns; ++column)
        draw_shell(picture, shells[static_cast<size_t>(column)], column, l);
    draw_reference(picture, columns, l);
    for (size_t i = 0; i < caption.size(); ++i)
        picture.draw_text(l.margin, l.caption_top + static_cast<int>(i) * l.line, caption[i], figure_faint, l.scale);
    return picture;
}

} // namespace scree
