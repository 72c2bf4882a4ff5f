#pragma once

#include "base/drawing/svg_plot.h"
#include "render/bench/bench_result.h"

#include <string>
#include <vector>

namespace scree {

/// Error against time, a line a method, with the reference's noise.
Plot convergence_plot(const BenchResult& result);
/// It as a part of a page, and what it shows.
std::string plot_figure(const BenchResult& result);
inline constexpr const char* plot_legend =
    "Mean over the pictures of all seeds, less the noise of the reference; below the dotted line, where points are "
    "hollow, the reference is not good enough to tell; hollow points on the lower edge came out at 0 or below. "
    "Methods without bias fall along a slope of -1/2; one with bias ends at it.";

/// One page on its own, without scripts: table, plots and pictures. Well-formed XML.
std::string page_of(const BenchResult& result);

/// The head of such a page up to its title, and its end; texts are escaped here.
std::string page_head(const std::string& title, const std::string& below);
std::string page_end();

/// A part of it: title and text are escaped here, `inside` is not.
std::string page_section(const std::string& title, const std::string& about, const std::string& inside);
std::string html_table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows);

} // namespace scree
