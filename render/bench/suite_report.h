#pragma once

#include "render/bench/bench_result.h"

#include <string>
#include <vector>

namespace scree {

/// The settings and results of a suite.
struct SuiteResult {
    std::string command; ///< that repeats the run
    double scale = 1; ///< factor of all times
    double seconds = 0; ///< wall-clock time of the whole suite
    std::vector<BenchResult> scenes;
};

/// The results on one screen: a line for each scene and method.
std::string suite_table(const SuiteResult& suite);

/// All columns as Markdown, with the command, the machine and the date. plots: whether to show the plots <name>.svg
/// below the table.
std::string suite_markdown(const SuiteResult& suite, bool plots);

/// All columns and the plots as a self-contained page.
std::string suite_page(const SuiteResult& suite);

/// All settings and results as JSON.
std::string suite_json(const SuiteResult& suite);

/// Replaces the part of `text` between "<!-- scree bench -->" and "<!-- /scree bench -->" by `block`. file: for
/// messages. Throws InputError unless both marks occur once, in this order.
std::string with_block(const std::string& text, const std::string& block, const std::string& file);

} // namespace scree
