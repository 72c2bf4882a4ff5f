#pragma once

#include "render/bench/bench_result.h"

#include <string>
#include <vector>

namespace scree {

/// What a suite was asked for and found.
struct SuiteResult {
    std::string command; ///< that brings it again
    double scale = 1; ///< of its times
    double seconds = 0; ///< by the clock, in all
    std::vector<BenchResult> scenes;
};

/// One screen: a line a scene and method.
std::string suite_table(const SuiteResult& suite);

/// The same, wider, as Markdown, with the command, the machine and the date. plots: whether the plots <name>.svg are
/// shown below it.
std::string suite_markdown(const SuiteResult& suite, bool plots);

/// The same as a page on its own, with its plots.
std::string suite_page(const SuiteResult& suite);

/// All of it as JSON.
std::string suite_json(const SuiteResult& suite);

/// text with what stands between "<!-- scree bench -->" and "<!-- /scree bench -->" replaced by block. file: for
/// messages. Throws InputError where the two are not there once each, in this order.
std::string with_block(const std::string& text, const std::string& block, const std::string& file);

} // namespace scree
