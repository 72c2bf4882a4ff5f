#pragma once

#include "render/bench/bench_result.h"

#include <string>
#include <vector>

namespace scree {

using TableRow = std::vector<std::string>;

/// What is shown of a scene in a line a method, the reference first: the columns of table_head.
std::vector<TableRow> table_rows(const BenchResult& result);
inline const TableRow table_head{
    "scene", "method", "does",        "spp",         "set up",          "render", "unit var.",      "against ept",
    "noise", "error",  "bias (95 %)", "bias of 8x8", "colour R G B, %", "FLIP",   "rays + events/s"};

/// What they mean, for people.
inline constexpr const char* table_legend =
    "Set up: processor time before the first sample; (cache): part of it was read from a cache of earlier runs. Unit "
    "var.: processor time of rendering, without set-up, until the relative variance is 1; "
    "against ept: how many times less of it than tracing every grain takes to the same variance, with one standard "
    "error. Errors are relative to what is around a pixel in the reference, root mean square. "
    "Bias: with <, no larger than chance brings, and so not measured: the most that it may be (95 %); of means of "
    "squares of 8x8 pixels smaller ones can be. Colour: error of the picture's mean, with one "
    "standard error. (ref.): no more can be told than the reference's noise, or the difference of its halves, which is "
    "its FLIP; (with ref.): the error holds that of the reference, whose noise is not known.";

/// The columns that fit on a screen, and what is to be known about the methods.
std::string terminal_table(const std::vector<BenchResult>& results);

} // namespace scree
