#pragma once

#include "render/bench/bench_result.h"

#include <string>
#include <vector>

namespace scree {

/// One screen: a line a scene and method. seconds: that all took.
std::string suite_table(const std::vector<BenchResult>& results, double seconds);

/// The same as Markdown, with the machine and the date. plots: whether the plots <name>.svg are shown below it.
std::string suite_markdown(const std::vector<BenchResult>& results, double seconds, bool plots);

/// The same as a page on its own, with its plots.
std::string suite_page(const std::vector<BenchResult>& results, double seconds);

/// What all results are as JSON.
std::string suite_json(const std::vector<BenchResult>& results, double seconds);

/// text with what stands between "<!-- scree bench -->" and "<!-- /scree bench -->" replaced by block. file: for messages.
/// Throws InputError where the two are not there once each, in this order.
std::string with_block(const std::string& text, const std::string& block, const std::string& file);

} // namespace scree
