#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace scree {

/// Something to draw: points (x, y), or bars of height y between neighbouring entries of x, which then has one more.
struct PlotSeries {
    enum class Style { line, dashes, dots, bars };
    std::string name; ///< for the legend; empty: not in it
    Style style = Style::line;
    std::vector<double> x, y;
    std::vector<double> error; ///< of y, drawn as whiskers on dots; may be empty
    /// Of a line: its points are dots too, these as rings; those not above 0 on a logarithmic axis stand on the lower
    /// edge. May be empty.
    std::vector<bool> hollow{};
};

/// A straight line across the plot at a value of x (or of y).
struct PlotMark {
    double value = 0;
    std::string name;
    bool horizontal = false;
};

/// A diagram with axes, ticks, labels and a legend.
struct Plot {
    std::string title, x_label, y_label; ///< the title is read by screen readers only
    bool log_x = false, log_y = false;
    std::vector<PlotSeries> series;
    std::vector<PlotMark> marks;
    std::optional<std::pair<double, double>> x_range, y_range; ///< of what is shown, where the data should not decide
};

/// The plot as an <svg> element that stands on its own; well-formed XML, the same for the same plot. Values that are
/// not finite, or not above 0 on a logarithmic axis, are left out. Lines after the sixth are dashed, as colours come
/// again.
std::string svg_of(const Plot& plot);

/// Text with &, <, > and quotes as XML wants them.
std::string xml_escaped(const std::string& text);

} // namespace scree
