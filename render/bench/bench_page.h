#pragma once

#include "base/drawing/svg_plot.h"
#include "render/bench/bench_result.h"

#include <string>
#include <vector>

namespace scree {

/// The plot of error against time: one line for each method, and the reference's noise.
Plot convergence_plot(const BenchResult& result);
/// The plot as part of a page, and its caption.
std::string plot_figure(const BenchResult& result);
inline constexpr const char* plot_legend =
    "Mean error over the pictures of all seeds; the noise of the reference is subtracted. Hollow points are below the "
    "dotted line, the noise of the reference, and not measurable; those on the lower edge were estimated at 0 or less. "
    "Methods without bias fall with a slope of -1/2; a method with bias levels off at its bias.";

/// A self-contained page without scripts: table, plots and pictures. Well-formed XML.
std::string page_of(const BenchResult& result);

/// The start of such a page with its title and the line below it, and the end of the page. Both texts are escaped here.
std::string page_head(const std::string& title, const std::string& below);
std::string page_end();

/// A section of a page: `title` and `about` are escaped here, `inside` is not.
std::string page_section(const std::string& title, const std::string& about, const std::string& inside);
std::string html_table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);

} // namespace scree
