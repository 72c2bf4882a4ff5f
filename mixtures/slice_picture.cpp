#include "mixtures/slice_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace scree {

namespace {

constexpr ScreenColor paper{255, 255, 255}, ink{40, 40, 40}, ground{246, 246, 244};
constexpr int margin = 20, gap = 46, label = 26;
constexpr size_t legend_lines = 24;

struct Bounds {
    Imath::V3d lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()}, middle{0};
};

Bounds bounds_of(const ParticleFrame& frame)
{
    Bounds b;
    Imath::V3d sum(0); // relative to the origin: sums of large coordinates would lose digits
    for (size_t i = 0; i < frame.size(); ++i) {
        sum += frame.position[i] - frame.origin;
        for (int a = 0; a < 3; ++a) {
            b.lo[a] = std::min(b.lo[a], frame.position[i][a] - frame.radius[i]);
            b.hi[a] = std::max(b.hi[a], frame.position[i][a] + frame.radius[i]);
        }
    }
    if (frame.size() == 0) return {Imath::V3d(0), Imath::V3d(1), Imath::V3d(0.5)};
    b.middle = frame.origin + sum / static_cast<double>(frame.size());
    const Imath::V3d extent = b.hi - b.lo;
    const double longest = std::max({extent.x, extent.y, extent.z}), size = longest > 0 ? longest : 1;
    for (int a = 0; a < 3; ++a) {
        const double least = size * 0.02; // points and flat sets still get a panel
        if (extent[a] >= least) continue;
        b.lo[a] -= least / 2;
        b.hi[a] += least / 2;
    }
    return b;
}

/// One slice: the plane normal to `normal`, with axis `right` to the right and `up` upwards.
struct Panel {
    int x, y, width, height, right, up, normal;
};

void draw_panel(Picture& picture, const Panel& panel, const ParticleFrame& frame, std::span<const uint32_t> types,
                const Bounds& bounds, const Imath::V3d& at, double scale)
{
    constexpr std::array<const char*, 3> axis{"x", "y", "z"};
    picture.fill_rectangle(panel.x, panel.y, panel.width, panel.height, ground);
    const auto to_x = [&](double v) { return panel.x + (v - bounds.lo[panel.right]) * scale; };
    const auto to_y = [&](double v) { return panel.y + panel.height - (v - bounds.lo[panel.up]) * scale; };
    const int clip[4] = {panel.x, panel.y, panel.width, panel.height};
    for (size_t i = 0; i < frame.size(); ++i) {
        const Imath::V3d& p = frame.position[i];
        const double d = p[panel.normal] - at[panel.normal], r = frame.radius[i];
        if (!(std::abs(d) < r)) continue;
        picture.draw_disc(to_x(p[panel.right]), to_y(p[panel.up]), std::sqrt(r * r - d * d) * scale,
                          type_color(types[i]), clip);
    }
    picture.draw_frame(panel.x, panel.y, panel.width, panel.height, ink);
    // Marks where the other two planes cut this one.
    const int cut_x = static_cast<int>(to_x(at[panel.right])), cut_y = static_cast<int>(to_y(at[panel.up]));
    for (int k = 0; k < 8; ++k) {
        picture.fill_rectangle(cut_x, panel.y + panel.height + k, 1, 1, ink);
        picture.fill_rectangle(panel.x + panel.width + k, cut_y, 1, 1, ink);
    }
    const auto name = [&](int a) { return axis[static_cast<size_t>(a)]; };
    const std::string text = fmt::format("{} = {:.4g}: {} right, {} up", name(panel.normal), at[panel.normal],
                                         name(panel.right), name(panel.up));
    picture.draw_text(panel.x, panel.y - label + 3, text, ink);
}

/// 1, 2 or 5 times a power of ten, at most `limit`.
double round_length(double limit)
{
    const double power = std::pow(10.0, std::floor(std::log10(limit)));
    return limit >= 5 * power ? 5 * power : limit >= 2 * power ? 2 * power : power;
}

std::string unit_of(const ParticleFrame& frame)
{
    if (frame.units == "si") return " m";
    return frame.units == "cgs" ? " cm" : "";
}

std::vector<std::pair<uint32_t, std::string>> legend_of(const ParticleFrame& frame, std::span<const uint32_t> types,
                                                        const std::vector<std::string>& names)
{
    std::vector<double> count(names.size(), 0), volume(names.size(), 0);
    double all_volume = 0;
    for (size_t i = 0; i < frame.size(); ++i) {
        const double r = frame.radius[i], v = r * r * r;
        count[types[i]] += 1;
        volume[types[i]] += v;
        all_volume += v;
    }
    std::vector<std::pair<uint32_t, std::string>> legend;
    for (uint32_t k = 0; k < names.size(); ++k) {
        if (count[k] == 0) continue;
        const double share = all_volume > 0 ? volume[k] / all_volume : 0;
        const double fraction = count[k] / static_cast<double>(frame.size());
        legend.emplace_back(k, fmt::format("{}  {:.3g} % ({:.3g} % vol)", names[k], 100 * fraction, 100 * share));
    }
    if (legend.size() > legend_lines) {
        const size_t more = legend.size() - legend_lines;
        legend.resize(legend_lines);
        legend.emplace_back(std::numeric_limits<uint32_t>::max(), fmt::format("and {} more", more));
    }
    return legend;
}

} // namespace

ScreenColor type_color(size_t k)
{
    // Okabe and Ito 2008, without black; then hues that turn by the golden angle.
    constexpr std::array<ScreenColor, 8> first{{{230, 159, 0},
                                                {0, 114, 178},
                                                {0, 158, 115},
                                                {204, 121, 167},
                                                {86, 180, 233},
                                                {213, 94, 0},
                                                {240, 228, 66},
                                                {120, 120, 120}}};
    if (k < first.size()) return first[k];
    const double hue = std::fmod(static_cast<double>(k) * 137.508, 360.0) / 60,
                 low = 0.35 + 0.15 * static_cast<double>(k % 3);
    const auto channel = [&](double shift) {
        const double h = std::fmod(hue + shift, 6.0), t = std::clamp(std::abs(h - 3) - 1, 0.0, 1.0);
        return static_cast<uint8_t>(255 * (low * 0.7 + (0.9 - low * 0.7) * t));
    };
    return {channel(0), channel(4), channel(2)};
}

Picture slice_picture(const ParticleFrame& frame, std::span<const uint32_t> types,
                      const std::vector<std::string>& names, const std::string& title, const SliceOptions& options)
{
    const Bounds bounds = bounds_of(frame);
    const Imath::V3d at = options.at.value_or(bounds.middle), extent = bounds.hi - bounds.lo;
    const auto legend = legend_of(frame, types, names);
    const int line = Picture::text_height() + 8;
    int legend_width = 0;
    for (const auto& [type, text] : legend) legend_width = std::max(legend_width, 30 + Picture::text_width(text));

    const int room = options.width - 2 * margin - gap;
    const double scale = std::min(room / (extent.x + extent.y), 0.9 * room / (extent.y + extent.z));
    const auto pixels = [&](double length) { return std::max(1, static_cast<int>(std::lround(length * scale))); };
    const int wx = pixels(extent.x), wy = pixels(extent.y), hy = pixels(extent.y), hz = pixels(extent.z);
    const int top = margin + line + label + 6;
    const int legend_height = static_cast<int>(legend.size()) * line + 60;
    const int first_row = std::max(hy, legend_height);
    const int width =
        std::max({margin + wx + gap + std::max(wy, legend_width) + margin, 2 * margin + Picture::text_width(title)});
    Picture picture(width, top + first_row + gap + hz + margin, paper);
    picture.draw_text(margin, margin - 4, title, ink);

    draw_panel(picture, {margin, top + first_row - hy, wx, hy, 0, 1, 2}, frame, types, bounds, at, scale);
    draw_panel(picture, {margin, top + first_row + gap, wx, hz, 0, 2, 1}, frame, types, bounds, at, scale);
    draw_panel(picture, {margin + wx + gap, top + first_row + gap, wy, hz, 1, 2, 0}, frame, types, bounds, at, scale);

    const int x = margin + wx + gap;
    int y = top;
    for (const auto& [type, text] : legend) {
        const int clip[4] = {0, 0, picture.width(), picture.height()};
        if (type < names.size()) picture.draw_disc(x + 10, y + 8, 8, type_color(type), clip);
        picture.draw_text(x + 30, y, text, ink);
        y += line;
    }
    const double bar = round_length(std::max(wx, 80) / scale / 3);
    y += 14;
    picture.fill_rectangle(x, y, pixels(bar), 4, ink);
    picture.fill_rectangle(x, y - 4, 2, 12, ink);
    picture.fill_rectangle(x + pixels(bar) - 2, y - 4, 2, 12, ink);
    picture.draw_text(x, y + 14, fmt::format("{:g}{}", bar, unit_of(frame)), ink);
    return picture;
}

} // namespace scree
