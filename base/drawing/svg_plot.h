#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace scree {

/// A data series: points (x, y), or bars of height y between neighbouring entries of x (x then has one entry more).
struct PlotSeries {
    enum class Style { line, dashes, dots, bars };
    std::string name; ///< for the legend; empty: no legend entry
    Style style = Style::line;
    std::vector<double> x, y;
    std::vector<double> error; ///< error of y, drawn as whiskers on dots; may be empty
    /// For a line: its points are also drawn as dots, as rings where true. A value not above 0 on a logarithmic axis is
    /// a ring at the lower edge. May be empty.
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
    std::string title, x_label, y_label; ///< only screen readers read the title
    bool log_x = false, log_y = false;
    std::vector<PlotSeries> series;
    std::vector<PlotMark> marks;
    std::optional<std::pair<double, double>> x_range, y_range; ///< the range to show; empty: chosen from the data
};

/// The plot as a self-contained <svg> element: well-formed XML, identical for identical plots. Values that are not
/// finite, or not above 0 on a logarithmic axis, are left out. Lines after the sixth are dashed, because the colours
/// repeat.
std::string svg_of(const Plot& plot);

/// Text with &, <, > and quotes escaped for XML.
std::string xml_escaped(const std::string& text);

} // namespace scree
