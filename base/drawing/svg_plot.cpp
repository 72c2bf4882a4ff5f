#include "base/drawing/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace scree {

namespace {

constexpr double width = 560, height = 330, left = 66, right = 14, bottom = 48, legend_line = 18;
// Distinguishable also for people who do not see red or green (Okabe, Ito 2008).
constexpr std::array<const char*, 6> colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};

/// One axis: the range it shows and its position on the page.
struct Axis {
    bool log = false;
    double lo = 0, hi = 1; ///< values; on a logarithmic axis their log10
    double from = 0, to = 1; ///< pixels

    bool shows(double v) const { return std::isfinite(v) && (!log || v > 0); }
    double pixel(double v) const { return pixel_at(log ? std::log10(v) : v); }
    double pixel_at(double place) const { return from + (place - lo) / (hi - lo) * (to - from); }
};

struct Tick {
    double place = 0; ///< in the unit of the axis' lo and hi
    std::string label; ///< SVG text; empty: a small tick
};

double nice_step(double extent, int wanted)
{
    const double raw = extent / wanted, power = std::pow(10, std::floor(std::log10(raw))), ratio = raw / power;
    return (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10) * power;
}

/// The label of m 10^k: a plain decimal number for k from -4 to 4, otherwise with a power of ten.
std::string plain(int k, int m)
{
    if (k >= -4 && k <= 4) return fmt::format("{:.{}f}", m * std::pow(10, k), std::max(0, -k));
    return fmt::format("{}10<tspan dy=\"-5\" font-size=\"9\">{}</tspan>", m == 1 ? "" : fmt::format("{}·", m), k);
}

std::vector<Tick> ticks_of(const Axis& axis, int wanted)
{
    std::vector<Tick> ticks;
    if (axis.log) {
        // Below 3 decades 2 and 5 have labels too (below 0.8 all digits), and the labels are plain numbers.
        const bool few = axis.hi - axis.lo < 3;
        const int first = static_cast<int>(std::ceil(axis.lo - 1e-9)),
                  last = static_cast<int>(std::floor(axis.hi + 1e-9));
        const int each = std::max(1, (last - first + wanted - 1) / wanted);
        for (int k = first - 1; k <= last; ++k) {
            const bool labelled = k >= first && (k - first) % each == 0;
            if (labelled)
                ticks.push_back(
                    {double(k), few ? plain(k, 1) : fmt::format("10<tspan dy=\"-5\" font-size=\"9\">{}</tspan>", k)});
            if (!labelled && k >= first && each < 5) ticks.push_back({double(k), ""});
            for (int m = 2; m < 10 && last - first < 4; ++m)
                if (const double place = k + std::log10(m); place > axis.lo && place < axis.hi)
                    ticks.push_back({place, few && (m == 2 || m == 5 || axis.hi - axis.lo < 0.8) ? plain(k, m) : ""});
        }
        return ticks;
    }
    const double step = nice_step(axis.hi - axis.lo, wanted);
    const double largest = std::max(std::abs(axis.lo), std::abs(axis.hi));
    const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 12);
    for (double k = std::ceil(axis.lo / step - 1e-9); k * step <= axis.hi + 1e-9 * step; ++k) {
        const double v = k * step;
        ticks.push_back({v, largest >= 1e6 || largest < 1e-4 ? fmt::format("{:.4g}", k == 0 ? 0 : v)
                                                             : fmt::format("{:.{}f}", k == 0 ? 0 : v, decimals)});
    }
    return ticks;
}

/// Sets the axis to the range of all values, with a margin above and, unless bars start at 0, below.
void fit(Axis& axis, const std::vector<double>& values, const std::optional<std::pair<double, double>>& wanted,
         bool from_zero, double room)
{
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    if (wanted) {
        lo = wanted->first;
        hi = wanted->second;
        room = 0;
    } else {
        for (const double v : values) {
            if (!axis.shows(v)) continue;
            lo = std::min(lo, v);
            hi = std::max(hi, v);
        }
        if (from_zero && !axis.log) lo = std::min(lo, 0.0);
    }
    if (!(lo <= hi)) lo = hi = 1;
    axis.lo = axis.log ? std::log10(lo) : lo;
    axis.hi = axis.log ? std::log10(hi) : hi;
    if (axis.hi - axis.lo <= 1e-12 * std::max(std::abs(axis.lo), std::abs(axis.hi))) {
        const double around = axis.log ? 0.5 : axis.lo == 0 ? 1 : 0.1 * std::abs(axis.lo);
        axis.lo -= from_zero && axis.lo == 0 ? 0 : around;
        axis.hi += around;
    }
    const double extent = axis.hi - axis.lo;
    axis.hi += room * extent;
    if (!(from_zero && !axis.log && axis.lo == 0)) axis.lo -= room * extent;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text, const char* more = "")
{
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more, text);
}

std::string line_between(double x1, double y1, double x2, double y2, const char* stroke, const char* more = "")
{
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"{}/>\n", x1, y1, x2,
                       y2, stroke, more);
}

std::string draw_axes(const Plot& plot, const Axis& x, const Axis& y)
{
    std::string svg;
    for (const Tick& t : ticks_of(x, 7)) {
        const double p = x.pixel_at(t.place);
        if (!t.label.empty()) svg += line_between(p, y.to, p, y.from, "#e6e9ed");
        svg += line_between(p, y.from, p, y.from + (t.label.empty() ? 3 : 5), "#556");
        if (!t.label.empty()) svg += text_at(p, y.from + 18, "middle", t.label);
    }
    for (const Tick& t : ticks_of(y, 6)) {
        const double p = y.pixel_at(t.place);
        if (!t.label.empty()) svg += line_between(x.from, p, x.to, p, "#e6e9ed");
        svg += line_between(x.from - (t.label.empty() ? 3 : 5), p, x.from, p, "#556");
        if (!t.label.empty()) svg += text_at(x.from - 8, p + 4, "end", t.label);
    }
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\" fill=\"none\" stroke=\"#556\"/>\n", x.from, y.to,
                       y.from, x.to);
    svg += text_at(0.5 * (x.from + x.to), height - 10, "middle", xml_escaped(plot.x_label), " fill=\"#223\"");
    const double middle = 0.5 * (y.from + y.to);
    svg += text_at(15, middle, "middle", xml_escaped(plot.y_label),
                   fmt::format(" fill=\"#223\" transform=\"rotate(-90 15 {:.1f})\"", middle).c_str());
    return svg;
}

std::string draw_bars(const PlotSeries& s, const Axis& x, const Axis& y, const char* colour)
{
    std::string svg = fmt::format("<g fill=\"{}\" fill-opacity=\"0.6\">\n", colour);
    const double ground = y.log ? y.from : std::clamp(y.pixel(0), y.to, y.from);
    for (size_t i = 0; i < s.y.size() && i + 1 < s.x.size(); ++i) {
        if (!y.shows(s.y[i]) || s.y[i] == 0 || !x.shows(s.x[i]) || !x.shows(s.x[i + 1])) continue;
        const double a = x.pixel(s.x[i]), b = x.pixel(s.x[i + 1]), top = y.pixel(s.y[i]);
        svg += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>\n", a,
                           std::min(top, ground), std::max(b - a, 0.5), std::abs(ground - top));
    }
    return svg + "</g>\n";
}

/// Whether the series is drawn with dashes: on request, or because its colour is a repeated one.
bool is_dashed(const Plot& plot, size_t series)
{
    return plot.series[series].style == PlotSeries::Style::dashes || series >= colours.size();
}

std::string draw_curve(const PlotSeries& s, const Axis& x, const Axis& y, const char* colour, bool dashed)
{
    std::string path, dots;
    bool pen_down = false;
    for (size_t i = 0; i < s.y.size() && i < s.x.size(); ++i) {
        const bool marked = i < s.hollow.size() && x.shows(s.x[i]) && std::isfinite(s.y[i]);
        if (marked) {
            dots += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"2.6\" fill=\"{}\" stroke=\"{}\"/>\n",
                                x.pixel(s.x[i]), y.shows(s.y[i]) ? y.pixel(s.y[i]) : y.from - 3,
                                s.hollow[i] || !y.shows(s.y[i]) ? "#fff" : colour, colour);
        }
        if (!x.shows(s.x[i]) || !y.shows(s.y[i])) {
            pen_down = false;
            continue;
        }
        // Points far outside are moved nearer: some viewers cannot handle huge coordinates.
        path += fmt::format("{}{:.2f} {:.2f}", pen_down ? 'L' : 'M', std::clamp(x.pixel(s.x[i]), -1e4, 1e4),
                            std::clamp(y.pixel(s.y[i]), -1e4, 1e4));
        pen_down = true;
    }
    if (path.empty()) return dots;
    return fmt::format(
               "<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\" stroke-linejoin=\"round\"{}/>\n", path,
               colour, dashed ? " stroke-dasharray=\"6 4\"" : "") +
           dots;
}

std::string draw_dots(const PlotSeries& s, const Axis& x, const Axis& y, const char* colour)
{
    std::string svg = fmt::format("<g fill=\"{0}\" stroke=\"{0}\">\n", colour);
    for (size_t i = 0; i < s.y.size() && i < s.x.size(); ++i) {
        if (!x.shows(s.x[i]) || !y.shows(s.y[i])) continue;
        const double px = x.pixel(s.x[i]), py = y.pixel(s.y[i]);
        if (i < s.error.size() && std::isfinite(s.error[i]) && s.error[i] > 0) {
            const double low = s.y[i] - s.error[i];
            svg += line_between(px, y.pixel(s.y[i] + s.error[i]), px, y.shows(low) ? y.pixel(low) : y.from, colour);
        }
        svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\" stroke=\"none\"/>\n", px, py,
                           s.y.size() == 1 ? 4 : 2.2);
    }
    return svg + "</g>\n";
}

/// Draws the marks; the names are one below the other, because marks may be close together.
std::string draw_marks(const Plot& plot, const Axis& x, const Axis& y)
{
    std::string svg;
    double line = y.to + 12;
    for (const PlotMark& mark : plot.marks) {
        const Axis& axis = mark.horizontal ? y : x;
        if (!axis.shows(mark.value)) continue;
        const double p = axis.pixel(mark.value);
        const char* halo = " paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"3\"";
        const char* dots = " stroke-width=\"1.4\" stroke-dasharray=\"2 3\"";
        svg += mark.horizontal ? line_between(x.from, p, x.to, p, "#556", dots)
                               : line_between(p, y.from, p, y.to, "#556", dots);
        const std::string name = xml_escaped(mark.name);
        if (mark.horizontal) {
            svg += text_at(x.from + 8, p - 5, "start", name, halo);
            continue;
        }
        const bool left_of_it = p > 0.65 * (x.from + x.to);
        svg += text_at(p + (left_of_it ? -5 : 5), line, left_of_it ? "end" : "start", name, halo);
        line += 14;
    }
    return svg;
}

std::string draw_legend(const Plot& plot, double& used)
{
    std::string svg;
    double x = left;
    used = 6;
    const auto place = [&](const std::string& name, const std::string& key) {
        // The continuation bytes of a UTF-8 character have no width.
        const auto letters =
            std::ranges::count_if(name, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; });
        const double wide = 42 + 6.8 * double(letters);
        if (x > left && x + wide > width - right) {
            x = left;
            used += legend_line;
        }
        svg += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}<text x=\"24\" y=\"12\">{}</text></g>\n", x,
                           used, key, xml_escaped(name));
        x += wide;
    };
    for (size_t i = 0; i < plot.series.size(); ++i) {
        const PlotSeries& s = plot.series[i];
        if (s.name.empty()) continue;
        const char* colour = colours[i % colours.size()];
        if (s.style == PlotSeries::Style::bars)
            place(s.name,
                  fmt::format("<rect x=\"2\" y=\"3\" width=\"16\" height=\"10\" fill=\"{}\" fill-opacity=\"0.6\"/>",
                              colour));
        else if (s.style == PlotSeries::Style::dots)
            place(s.name, fmt::format("<circle cx=\"10\" cy=\"8\" r=\"2.6\" fill=\"{}\"/>", colour));
        else
            place(s.name, fmt::format("<line x1=\"0\" y1=\"8\" x2=\"19\" y2=\"8\" stroke=\"{}\" stroke-width=\"2\"{}/>",
                                      colour, is_dashed(plot, i) ? " stroke-dasharray=\"6 4\"" : ""));
    }
    if (!svg.empty()) used += legend_line;
    return svg;
}

} // namespace

std::string xml_escaped(const std::string& text)
{
    std::string out;
    for (const char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t')
            out += ' '; // XML cannot contain control characters
        else
            out += c;
    }
    return out;
}

std::string svg_of(const Plot& plot)
{
    double legend_height = 0;
    const std::string legend = draw_legend(plot, legend_height);
    Axis x{plot.log_x, 0, 1, left, width - right}, y{plot.log_y, 0, 1, height - bottom, legend_height + 8};
    std::vector<double> xs, ys;
    bool bars = false;
    for (const PlotSeries& s : plot.series) {
        xs.insert(xs.end(), s.x.begin(), s.x.end());
        ys.insert(ys.end(), s.y.begin(), s.y.end());
        bars = bars || s.style == PlotSeries::Style::bars;
    }
    for (const PlotMark& mark : plot.marks) (mark.horizontal ? ys : xs).push_back(mark.value);
    fit(x, xs, plot.x_range, false, bars ? 0 : 0.02);
    fit(y, ys, plot.y_range, bars, 0.06);

    std::string svg = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0f} {:.0f}\" "
                                  "role=\"img\" font-family=\"system-ui, sans-serif\" "
                                  "font-size=\"12\" fill=\"#445\">\n<title>{}</title>\n",
                                  width, height, xml_escaped(plot.title));
    svg += legend + draw_axes(plot, x, y);
    // An inner <svg> cuts off what lies outside of the axes, without the ids that clip paths would need.
    svg += fmt::format("<svg x=\"{0:.1f}\" y=\"{1:.1f}\" width=\"{2:.1f}\" height=\"{3:.1f}\" viewBox=\"{0:.1f} "
                       "{1:.1f} {2:.1f} {3:.1f}\">\n",
                       x.from, y.to, x.to - x.from, y.from - y.to);
    for (size_t i = 0; i < plot.series.size(); ++i) {
        const PlotSeries& s = plot.series[i];
        const char* colour = colours[i % colours.size()];
        svg += s.style == PlotSeries::Style::bars   ? draw_bars(s, x, y, colour)
               : s.style == PlotSeries::Style::dots ? draw_dots(s, x, y, colour)
                                                    : draw_curve(s, x, y, colour, is_dashed(plot, i));
    }
    svg += draw_marks(plot, x, y);
    return svg + "</svg>\n</svg>\n";
}

} // namespace scree
