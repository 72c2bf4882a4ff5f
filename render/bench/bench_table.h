#pragma once

#include "render/bench/bench_result.h"

#include <string>
#include <vector>

namespace scree {

using TableRow = std::vector<std::string>;

/// The table of a scene: the reference, then one row for each method; its columns are those of table_head.
std::vector<TableRow> table_rows(const BenchResult& result);
inline const TableRow table_head{
    "scene", "method", "does",        "spp",         "set up",          "render", "unit var.",      "against ept",
    "noise", "error",  "bias (95 %)", "bias of 8x8", "colour R G B, %", "FLIP",   "rays + events/s"};

/// Explains the columns; also the caption of the table in a README.
inline constexpr const char* table_legend =
    "Set up: processor time before the first sample; (cache): part of it was read from a cache of earlier runs. Unit "
    "var.: processor time of rendering, without set-up, until the relative variance is 1. Against ept: how many times "
    "faster than ept, which traces every grain, the method reaches the same variance, with one standard error. Noise, "
    "error and bias are root mean squares, relative to the reference around each pixel. Bias: a value with < is an "
    "upper bound (95 %), because the bias is too small to tell from chance. Bias of 8x8: bias of the means of squares "
    "of 8x8 pixels, where a smaller bias can be measured. Colour: error of the picture's mean, with one standard "
    "error. (ref.): below the reference's noise, not measurable; for FLIP, below the FLIP between the reference's "
    "halves. (with ref.): the error includes the reference's noise, which is not known.";

/// The columns that fit on a screen, then notes and warnings about the methods.
std::string terminal_table(const std::vector<BenchResult>& results);

} // namespace scree
