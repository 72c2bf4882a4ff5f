#pragma once

#include "packing/report/svg_plot.h"
#include "render/bench/bench_result.h"

#include <string>

namespace scree {

/// Error against time, a line a method, with the reference's noise.
Plot convergence_plot(const BenchResult& result);

/// One page on its own, without scripts: table, plots and pictures. Well-formed XML.
std::string page_of(const BenchResult& result);

/// The head of such a page up to its title, and its end; text is to be escaped.
std::string page_head(const std::string& title, const std::string& below);
std::string page_end();

} // namespace scree
